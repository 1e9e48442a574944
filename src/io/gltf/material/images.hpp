#pragma once
/// The images of an asset.

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

/// What drawn materials take an image's numbers for; neither where they do not show it.
struct ImageUse {
  bool srgb = false, linear = false;

  [[nodiscard]] bool is_wanted() const { return srgb || linear; }
};

/// How those materials that are drawn use each of so many images.
[[nodiscard]] std::vector<ImageUse> image_uses(std::span<const Material> materials,
                                               const std::vector<bool>& drawn,
                                               std::span<const Texture> textures,
                                               std::size_t images, SurfaceDetail detail);

/// By index: the pixels of those that are wanted and can be decoded, null for the others. All are
/// looked at. Kinds of files that are not read give a warning; a header or, where it is wanted,
/// data that is damaged throws Error (invalid_scene); as read_resource, and (limit) where the
/// wanted ones have more than max_texture_pixels together.
[[nodiscard]] std::vector<std::shared_ptr<const Image>> load_images(
    Asset& asset, const BufferViews& views, const ResourceFolders& folders,
    const std::vector<ImageUse>& uses);

}  // namespace microtrace::io::gltf
