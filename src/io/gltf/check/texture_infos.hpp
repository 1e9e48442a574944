#pragma once
/// The vertex attributes that materials need for their textures.

#include "io/gltf/document/asset.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

/// The maximum number of texture coordinate sets. glTF 2.0 requires support for two.
inline constexpr std::uint32_t kMaxUvSets = 16;

struct MaterialTextures {
  std::vector<std::pair<std::string, double>> sets;  ///< each texture's key and TEXCOORD set
  /// True if the vertices need TANGENT: the material has anisotropy or a clear coat normal texture,
  /// but no normal texture, whose coordinates would define tangents.
  bool needs_tangents = false;
};

/// Returns the texture infos of each material and its extensions.
[[nodiscard]] std::vector<MaterialTextures> texture_infos(const Asset& asset);

}  // namespace microtrace::io::gltf
