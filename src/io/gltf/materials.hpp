#pragma once
/// The materials of an asset, and the textures they use.

#include "io/gltf/asset.hpp"

#include <microtrace/material.hpp>
#include <microtrace/texture.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::io::gltf {

/// All materials in file order, and after them the one of primitives that name none (glTF 2.0,
/// section 3.9.7).
[[nodiscard]] std::vector<Material> make_materials(const Asset& asset);

/// All textures in file order; of the images that one offers the one in WebP (EXT_texture_webp)
/// before PNG and JPEG. Warns of those that offer none of these.
[[nodiscard]] std::vector<Texture> make_textures(Asset& asset);

}  // namespace microtrace::io::gltf
