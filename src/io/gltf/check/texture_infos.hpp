#pragma once
/// What the textures of materials ask of vertices.

#include "io/gltf/document/asset.hpp"

#include <string>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

struct MaterialTextures {
  std::vector<std::pair<std::string, double>>
      sets;                     ///< a texture's name, and the TEXCOORD it takes
  bool needs_tangents = false;  ///< and has no normal texture to make them from
};

/// Of each material, those of its extensions among them.
[[nodiscard]] std::vector<MaterialTextures> texture_infos(const Asset& asset);

}  // namespace microtrace::io::gltf
