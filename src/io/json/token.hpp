#pragma once
/// Where the tokens of a JSON text end, for tokens already known to be well-formed.

#include <cstddef>
#include <string_view>

namespace microtrace::io {

/// The byte after the string token that starts at `start`.
[[nodiscard]] std::size_t string_end(std::string_view text, std::size_t start);

/// The byte after the number token that starts at `start`.
[[nodiscard]] std::size_t number_end(std::string_view text, std::size_t start);

}  // namespace microtrace::io
