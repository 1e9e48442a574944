#pragma once
/// Reports images that can't be read.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/material/images.hpp"

#include <microtrace/texture.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Why an image can't be read.
struct ImageProblem {
  enum class Kind { limitation, violation, damaged_header } kind;
  Element at;
  std::string message;   ///< precedes the words about what is drawn instead
  std::string reason{};  ///< follows them
};

/// Warns about each image that has a problem. `textures` have the images that they are drawn with,
/// and `choices` are all images of each texture. Throws Error (invalid_scene) for an image with a
/// damaged header, unless each of its textures has an image without one.
void report_problems(Asset& asset, std::span<const std::optional<ImageProblem>> problems,
                     std::span<const ImageUse> uses, std::span<const Texture> textures,
                     std::span<const std::vector<std::uint32_t>> choices);

}  // namespace microtrace::io::gltf
