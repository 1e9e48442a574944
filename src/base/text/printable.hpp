#pragma once
/// Makes untrusted text safe to print on a terminal, so that it can neither move the cursor nor
/// change the reading order.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace {

struct PrintableText {
  std::string text;
  std::size_t columns = 0;  ///< width on a terminal, assuming one column per character
};

/// Replaces tabs by spaces. Escapes control characters, invisible and bidirectional formatting
/// characters, and bytes that are not UTF-8, byte by byte in the form \x1b.
[[nodiscard]] PrintableText make_printable(std::string_view text);

/// Returns the text of make_printable().
[[nodiscard]] std::string printable(std::string_view text);

/// Returns `name` truncated to 60 bytes, made printable, and in double quotes.
[[nodiscard]] std::string in_quotes(std::string_view name);

/// Returns the length in bytes of the first UTF-8 character; 0 if `text` doesn't start with one.
/// `text` must not be empty.
[[nodiscard]] std::size_t character_length(std::string_view text);

/// Returns true if c is a continuation byte of a UTF-8 character.
[[nodiscard]] bool continues_character(char c);

/// Returns `text` without an incomplete UTF-8 character at the end.
[[nodiscard]] std::string_view whole_characters(std::string_view text);

}  // namespace microtrace
