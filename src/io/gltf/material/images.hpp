#pragma once
/// Loads and decodes images.

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

/// The encodings in which drawn materials read an image. Both are false if no material reads it.
struct ImageUse {
  bool srgb = false, linear = false;

  [[nodiscard]] bool is_wanted() const { return srgb || linear; }
};

/// Returns the uses of each image by the drawn materials in a picture with this detail.
[[nodiscard]] std::vector<ImageUse> image_uses(std::span<const Material> materials,
                                               const std::vector<bool>& drawn,
                                               std::span<const Texture> textures,
                                               std::size_t images, SurfaceDetail detail);

/// Returns the decoded pixels of each wanted image, or null for an image that is not wanted or
/// can't be decoded. Examines all images. Textures whose image can't be decoded get the next one
/// that they have. Warns about images that can't be decoded. Throws the errors of read_resource,
/// and Error: invalid_scene for an image with a damaged header, unless each of its textures has an
/// image without one; limit if the decoded images have more than kMaxTexturePixels together.
[[nodiscard]] std::vector<std::shared_ptr<const Image>> load_images(Asset& asset,
                                                                    const BufferViews& views,
                                                                    const ResourceFolders& folders,
                                                                    std::vector<ImageUse> uses,
                                                                    std::vector<Texture>& textures);

}  // namespace microtrace::io::gltf
