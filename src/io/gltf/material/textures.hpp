#pragma once
/// Reads the textures of an asset.

#include "io/gltf/document/asset.hpp"

#include <microtrace/texture.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::io::gltf {

/// Returns the images of a texture in the order of precedence: WebP (EXT_texture_webp), KTX2
/// (KHR_texture_basisu), PNG or JPEG.
[[nodiscard]] std::vector<std::uint32_t> images_of(const JsonValue& texture);

/// Returns all textures in file order, each with the first of its images. Warns about textures
/// without an image.
[[nodiscard]] std::vector<Texture> make_textures(Asset& asset);

}  // namespace microtrace::io::gltf
