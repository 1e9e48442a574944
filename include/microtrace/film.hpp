#pragma once
/// The picture being made.

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>
#include <microtrace/tone_map.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace microtrace {

/// Pixels [x0, x1) x [y0, y1), counted from the picture's upper left corner.
struct PixelRect {
  std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] ImageSize size() const { return {.width = x1 - x0, .height = y1 - y0}; }
  [[nodiscard]] bool operator==(const PixelRect&) const = default;
};

/// How 8-bit formats show a film's numbers; float formats hold the numbers themselves.
struct Display {
  bool srgb = true;  ///< linear light, encoded by sRGB's curve; else v is shown as
                     ///< round(255 (scale v + offset)), clamped
  Vec3 scale{1}, offset{0};
  double exposure = 0;  ///< of linear light, in stops: it is multiplied with 2^exposure
  ToneMap tone_map = ToneMap::none;  ///< of linear light, after exposure and before the encoding
};

/// One number for each pixel beside the colours, row by row from the upper left.
struct Channel {
  std::string name;  ///< as OpenEXR's: "depth.Z", "id.instance"
  std::variant<std::vector<float>, std::vector<std::uint32_t>> values;
};

/// width x height linear Rec. 709 colours, row by row from the upper left, with alpha or without.
class Film {
 public:
  enum class Alpha { none, premultiplied };

  /// All pixels black, and transparent where there is alpha.
  explicit Film(ImageSize size, Alpha alpha = Alpha::none)
      : whole(size),
        size_(size),
        pixels_(std::size_t{size.width} * size.height),
        alpha_(alpha == Alpha::none ? 0 : pixels_.size()) {}

  [[nodiscard]] ImageSize size() const { return size_; }
  [[nodiscard]] Vec3& at(std::uint32_t x, std::uint32_t y) { return pixels_[index(x, y)]; }
  [[nodiscard]] std::span<const Vec3> row(std::uint32_t y) const {
    return std::span(pixels_).subspan(index(0, y), size_.width);
  }

  /// The colours are then multiplied with it.
  [[nodiscard]] bool has_alpha() const { return !alpha_.empty(); }
  /// Where the film has alpha: 0 transparent, 1 opaque.
  [[nodiscard]] float& alpha_at(std::uint32_t x, std::uint32_t y) { return alpha_[index(x, y)]; }
  [[nodiscard]] std::span<const float> alpha_row(std::uint32_t y) const {
    return std::span(alpha_).subspan(index(0, y), size_.width);
  }

  ImageSize whole;               ///< the picture that this film is a part of
  std::uint32_t x0 = 0, y0 = 0;  ///< this film's upper left pixel there
  Display display{};
  std::vector<Channel> channels{};  ///< each with a number for every pixel of this film

 private:
  [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y} * size_.width + x;
  }

  ImageSize size_;
  std::vector<Vec3> pixels_;
  std::vector<float> alpha_;
};

}  // namespace microtrace
