#pragma once
/// Images, samplers and textures.

#include <microtrace/math.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace microtrace {

/// An image as stored in the file, row by row from the upper left. The material that uses the image
/// defines whether its colors are sRGB or linear.
struct Image {
  std::string name{};
  std::uint32_t width = 0, height = 0;  ///< pixels, at least 1
  std::uint32_t channels = 4;           ///< 1: gray, 2: gray and alpha, 3: rgb, 4: rgb and alpha
  /// width * height * channels integers of 8 or 16 bits, whose maximum value means 1. Colors are
  /// not premultiplied with alpha.
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>> samples{};
};

enum class Wrap { repeat, mirrored_repeat, clamp_to_edge };
enum class Filter { nearest, linear };
enum class MipFilter { none, nearest, linear };  ///< none: always the base level

/// Wrapping and filtering of an image (glTF 2.0, section 3.8.4).
struct Sampler {
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  Filter magnification = Filter::linear;
  Filter minification = Filter::linear;
  MipFilter mip = MipFilter::linear;
};

struct Texture {
  std::string name{};
  std::optional<std::uint32_t> image{};  ///< index into Scene::images; nothing: white
  Sampler sampler{};
};

/// The encoding of an image's colors. Alpha is linear in both.
enum class ColorEncoding { srgb, linear };

/// A material's reference to a texture.
struct TextureUse {
  std::uint32_t texture = 0;  ///< index into Scene::textures
  std::uint32_t uv_set = 0;   ///< index into Mesh::uv_sets; the coordinates are (0, 0) if the mesh
                              ///< lacks this set
  Mat3x2 texture_from_uv{1};  ///< transforms the mesh's texture coordinates (KHR_texture_transform)

  bool operator==(const TextureUse&) const = default;
};

}  // namespace microtrace
