#pragma once
/// The line of a file that a message is about.

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
/// Both are printable.
[[nodiscard]] std::string excerpt(std::string_view text, std::size_t offset);

}  // namespace microtrace::io
