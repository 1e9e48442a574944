#pragma once
/// Untrusted text made safe to show on a terminal: nothing in it moves the cursor or changes the
/// reading order.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace {

struct PrintableText {
  std::string text;
  std::size_t columns = 0;  ///< on a terminal where each character takes one
};

/// Tabs become spaces; control characters, invisible and bidirectional formatting characters, and
/// bytes that are not UTF-8 are written as \x1b.
[[nodiscard]] PrintableText make_printable(std::string_view text);

/// The text of make_printable.
[[nodiscard]] std::string printable(std::string_view text);

/// `name` in double quotes, printable and cut to 60 bytes.
[[nodiscard]] std::string in_quotes(std::string_view name);

/// Is this a second or later byte of a UTF-8 character?
[[nodiscard]] bool continues_character(char c);

/// `text` without an incomplete UTF-8 character at its end.
[[nodiscard]] std::string_view whole_characters(std::string_view text);

}  // namespace microtrace
