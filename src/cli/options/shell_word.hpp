#pragma once
/// Quotes words for shells.

#include <string>

namespace microtrace::cli {

/// Quotes the text for any shell. Fish is the only one that interprets backslashes within single
/// quotes.
[[nodiscard]] std::string in_single_quotes(const std::string& text);

/// Quotes the word if a shell would not take it as it is.
[[nodiscard]] std::string shell_word(const std::string& word);

}  // namespace microtrace::cli
