#pragma once
/// Divides lists of names and numbers.

#include <cstddef>
#include <string_view>
#include <vector>

namespace microtrace {

/// Returns the parts of a text before, between and after its commas. They may be empty.
[[nodiscard]] inline std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace microtrace
