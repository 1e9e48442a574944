#pragma once
/// The vertex attributes that the textures of materials need.

#include "io/gltf/document/asset.hpp"

#include <string>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

struct MaterialTextures {
  std::vector<std::pair<std::string, double>> sets;  ///< the key of a texture, and its TEXCOORD set
  bool needs_tangents = false;  ///< needs TANGENT, as no normal texture defines tangents
};

/// For each material, its extensions included.
[[nodiscard]] std::vector<MaterialTextures> texture_infos(const Asset& asset);

}  // namespace microtrace::io::gltf
