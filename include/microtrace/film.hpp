#pragma once
/// Films, which hold rendered pictures.

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>
#include <microtrace/page_allocator.hpp>
#include <microtrace/tone_map.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace microtrace {

/// How 8-bit formats show a film's values; float formats store the values themselves.
struct Display {
  bool srgb = true;  ///< true: values are linear light and are encoded by the sRGB curve; false: a
                     ///< value v is stored as round(255 (scale v + offset)), clamped to [0, 255]
  Vec3 scale{1}, offset{0};
  double exposure = 0;               ///< for linear light only, in stops: a factor of 2^exposure
  ToneMap tone_map = ToneMap::none;  ///< for linear light only, after exposure, before encoding
};

/// One value per pixel in addition to the colors, row by row from the upper left.
struct Channel {
  std::string name;  ///< in OpenEXR's style: "depth.Z", "id.instance"
  std::variant<std::vector<float>, std::vector<std::uint32_t>> values;
};

/// A picture of width x height colors in linear Rec. 709, with or without alpha, stored row by row
/// from the upper left.
class Film {
 public:
  enum class Alpha { none, premultiplied };

  /// Creates a film whose pixels are black, and transparent if the film has alpha.
  explicit Film(ImageSize size, Alpha alpha = Alpha::none)
      : whole(size),
        size_(size),
        pixels_(zeros<Vec3>(std::size_t{size.width} * size.height)),
        alpha_(zeros<float>(alpha == Alpha::none ? 0 : pixels_.size())) {}

  [[nodiscard]] ImageSize size() const { return size_; }
  [[nodiscard]] Vec3& at(std::uint32_t x, std::uint32_t y) { return pixels_[index(x, y)]; }
  [[nodiscard]] std::span<const Vec3> row(std::uint32_t y) const {
    return std::span(pixels_).subspan(index(0, y), size_.width);
  }

  /// If true, colors are premultiplied with alpha.
  [[nodiscard]] bool has_alpha() const { return !alpha_.empty(); }
  /// Requires has_alpha(). 0 is transparent, 1 opaque.
  [[nodiscard]] float& alpha_at(std::uint32_t x, std::uint32_t y) { return alpha_[index(x, y)]; }
  [[nodiscard]] std::span<const float> alpha_row(std::uint32_t y) const {
    return std::span(alpha_).subspan(index(0, y), size_.width);
  }

  ImageSize whole;               ///< size of the whole picture, of which this film may be a part
  std::uint32_t x0 = 0, y0 = 0;  ///< position of this film's upper left pixel in the whole picture
  Display display{};
  std::string denoiser{};   ///< name and version of the denoiser of the colors; empty: none
  bool has_lens = false;    ///< the lens of the camera makes all channels for denoising noisy
  bool has_ground = false;  ///< shadows on a ground make emission noisy
  std::vector<Channel> channels{};  ///< each has one number for every pixel of this film

 private:
  [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y} * size_.width + x;
  }

  ImageSize size_;
  PageVector<Vec3> pixels_;
  PageVector<float> alpha_;
};

}  // namespace microtrace
