#pragma once
/// Finds the ends of tokens.

#include <cstddef>
#include <string_view>

namespace microtrace::io {

/// Returns the first byte from `offset` on that isn't white space.
[[nodiscard]] inline std::size_t skip_whitespace(std::string_view text, std::size_t offset) {
  const auto is_white = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
  while (offset < text.size() && is_white(text[offset])) ++offset;
  return offset;
}

/// The extent of a string token. It is well-formed if it is closed and its escapes and UTF-8 are
/// valid.
struct StringExtent {
  /// The byte after the closing quote. If the string isn't closed, the first control character or
  /// the end of the text.
  std::size_t end = 0;
  bool is_closed = false;
  bool is_verbatim = true;  ///< contains no escapes and no bytes beyond ASCII
};

/// Finds the end of the string whose opening quote is at `start`.
[[nodiscard]] StringExtent string_extent(std::string_view text, std::size_t start);

/// Returns the byte after the well-formed number that starts at `start`.
[[nodiscard]] std::size_t number_end(std::string_view text, std::size_t start);

}  // namespace microtrace::io
