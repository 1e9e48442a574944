#pragma once
/// Finds the ends of tokens that are known to be well-formed.

#include <cstddef>
#include <string_view>

namespace microtrace::io {

/// Returns the byte after the string that starts at `start`.
[[nodiscard]] std::size_t string_end(std::string_view text, std::size_t start);

/// Returns the byte after the number that starts at `start`.
[[nodiscard]] std::size_t number_end(std::string_view text, std::size_t start);

}  // namespace microtrace::io
