#pragma once
/// Parses indices written as text.

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace microtrace::io::gltf {

/// Returns the number, if the text consists of decimal digits only.
[[nodiscard]] inline std::optional<std::size_t> index_in(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Returns the set number of a vertex attribute, for example 1 for TEXCOORD_1.
[[nodiscard]] inline std::optional<std::size_t> set_in(std::string_view attribute) {
  return index_in(attribute.substr(attribute.find('_') + 1));
}

}  // namespace microtrace::io::gltf
