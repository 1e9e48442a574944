#pragma once
/// Loading and decoding of images.

#include "io/gltf/bytes/buffer_views.hpp"
#include "io/gltf/bytes/resource.hpp"
#include "io/gltf/document/asset.hpp"

#include <microtrace/io.hpp>
#include <microtrace/material.hpp>
#include <microtrace/texture.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace microtrace::io::gltf {

/// The encodings in which drawn materials are read from an image; none if nothing reads it.
struct ImageUse {
  bool srgb = false, linear = false;

  [[nodiscard]] bool is_wanted() const { return srgb || linear; }
};

/// The uses of each image by the drawn materials, with this detail.
[[nodiscard]] std::vector<ImageUse> image_uses(std::span<const Material> materials,
                                               const std::vector<bool>& drawn,
                                               std::span<const Texture> textures,
                                               std::size_t images, SurfaceDetail detail);

/// The pixels of each wanted image that can be decoded, null for the others. Examines all images.
/// Warns of unsupported formats. Throws Error: invalid_scene for a damaged header or, in a wanted
/// image, damaged data; those of read_resource; limit if the wanted images have more than
/// kMaxTexturePixels together.
[[nodiscard]] std::vector<std::shared_ptr<const Image>> load_images(
    Asset& asset, const BufferViews& views, const ResourceFolders& folders,
    const std::vector<ImageUse>& uses);

}  // namespace microtrace::io::gltf
