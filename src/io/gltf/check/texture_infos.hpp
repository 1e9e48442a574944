#pragma once
/// The vertex attributes that materials need for their textures.

#include "io/gltf/document/asset.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

/// The maximum number of texture coordinate sets. glTF 2.0 requires support for two.
inline constexpr std::uint32_t kMaxUvSets = 16;

struct MaterialTextures {
  std::vector<std::pair<std::string, double>> sets;  ///< each texture's key and TEXCOORD set
  /// If the vertices need TANGENT, the TEXCOORD set from which missing tangents are generated. This
  /// is the case if the material has anisotropy or a clear coat normal texture, but no normal
  /// texture, whose coordinates would define tangents.
  std::optional<double> tangent_set{};
};

/// Returns the texture infos of each material and its extensions.
[[nodiscard]] std::vector<MaterialTextures> texture_infos(const Asset& asset);

}  // namespace microtrace::io::gltf
