#pragma once
/// Shows the source line to which a message refers.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace::io {

/// A position in a text, counted from 1; the column is in bytes.
struct Place {
  std::size_t line = 1, column = 1;
};

[[nodiscard]] Place place_of(std::string_view text, std::size_t offset);

/// Returns the line that contains the byte at `offset`, truncated to 120 columns, and below it a
/// caret under this byte. Unprintable characters are escaped.
[[nodiscard]] std::string excerpt(std::string_view text, std::size_t offset);

}  // namespace microtrace::io
