#pragma once
/// Text from a file shown to a person: nothing in it moves the cursor or turns the reading order.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace::io {

/// A place in a text: from 1, the column in bytes.
struct Place {
  std::size_t line = 1, column = 1;
};

[[nodiscard]] Place place_of(std::string_view text, std::size_t offset);

/// The line around the byte at `offset`, cut to 120 columns, and below it a caret under that byte.
/// Tabs become spaces; control characters and bytes that are not UTF-8 are shown as \x1b.
[[nodiscard]] std::string excerpt(std::string_view text, std::size_t offset);

/// `name` in double quotes, made safe in the same way and cut to 60 bytes.
[[nodiscard]] std::string in_quotes(std::string_view name);

/// All of `text`, made safe in the same way.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace microtrace::io
