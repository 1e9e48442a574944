#pragma once
/// The vertex attributes that the textures of materials need.

#include "io/gltf/document/asset.hpp"

#include <string>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

struct MaterialTextures {
  std::vector<std::pair<std::string, double>> sets;  ///< each texture's key and TEXCOORD set
  /// True if the vertices need TANGENT because no normal texture defines tangents.
  bool needs_tangents = false;
};

/// Returns the texture infos of each material and its extensions.
[[nodiscard]] std::vector<MaterialTextures> texture_infos(const Asset& asset);

}  // namespace microtrace::io::gltf
