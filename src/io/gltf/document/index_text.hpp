#pragma once
/// Indices in texts.

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace microtrace::io::gltf {

/// The number that the text is, in decimal digits alone.
[[nodiscard]] inline std::optional<std::size_t> index_in(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The number of a set of vertex attributes, 1 for TEXCOORD_1.
[[nodiscard]] inline std::optional<std::size_t> set_in(std::string_view attribute) {
  return index_in(attribute.substr(attribute.find('_') + 1));
}

}  // namespace microtrace::io::gltf
