#pragma once
#include "base/text/index_text.hpp"

#include <cstddef>
#include <optional>
#include <string_view>

namespace microtrace::io::gltf {

using microtrace::index_in;

/// Returns the set number of a vertex attribute, for example 1 for TEXCOORD_1.
[[nodiscard]] inline std::optional<std::size_t> set_in(std::string_view attribute) {
  return index_in(attribute.substr(attribute.find('_') + 1));
}

}  // namespace microtrace::io::gltf
