#pragma once
/// Makes untrusted text safe to print on a terminal: it can't move the cursor or change the reading
/// order.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace {

struct PrintableText {
  std::string text;
  std::size_t columns = 0;  ///< on a terminal, with one column per character
};

/// Replaces tabs by spaces, and escapes control characters, invisible and bidirectional formatting
/// characters, and bytes that are not UTF-8 as \x1b.
[[nodiscard]] PrintableText make_printable(std::string_view text);

/// The text of make_printable().
[[nodiscard]] std::string printable(std::string_view text);

/// `name` in double quotes, printable and truncated to 60 bytes.
[[nodiscard]] std::string in_quotes(std::string_view name);

/// True if this is a continuation byte of a UTF-8 character.
[[nodiscard]] bool continues_character(char c);

/// `text` without an incomplete UTF-8 character at its end.
[[nodiscard]] std::string_view whole_characters(std::string_view text);

}  // namespace microtrace
