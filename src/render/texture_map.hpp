#pragma once
/// Looking up images.

#include "render/texture_pyramid.hpp"

#include <microtrace/math.hpp>
#include <microtrace/texture.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace microtrace {

/// How far texture coordinates go from one sample of the picture to the next, across and down.
struct TextureFootprint {
  DVec2 dx{0}, dy{0};
};

/// An image with a sampler, ready for look-ups. Everything is filtered in linear light, alpha apart
/// from colour.
class TextureMap {
 public:
  /// Has the pyramid make its mip maps if the sampler asks for them.
  TextureMap(const std::shared_ptr<TexturePyramid>& pyramid, const Sampler& sampler);

  /// With a pyramid of its own. The image must outlive this.
  TextureMap(const Image& image, const Sampler& sampler, ColorEncoding encoding);

  /// The colour at uv, of which (0, 0) is the upper left corner of the image and (1, 1) the lower
  /// right one. Where the image's pixels look larger than the samples, by the magnification filter;
  /// else by the others, from up to kMaxProbes places along the longer side of the footprint, so
  /// that surfaces seen at a slant are not blurred more than they must.
  [[nodiscard]] DVec4 look_up(const DVec2& uv, const TextureFootprint& footprint) const;

  /// The same in float32 by one bilinear look-up in the level whose pixels are nearest below
  /// `width` in size, which is a part of the image's width and height: for random samples, which
  /// together are the filter.
  [[nodiscard]] Vec4 sample(const Vec2& uv, float width) const { return sample(place(uv, width)); }

  /// Between two pixels of a row or a column, and how far from the first to the second.
  struct Between {
    std::int32_t first, second;
    float share;
  };
  /// Where sample() looks.
  struct Place {
    std::size_t level;
    std::uint32_t columns;  ///< of that level
    Between x, y;
  };
  [[nodiscard]] Place place(const Vec2& uv, float width) const;
  [[nodiscard]] Vec4 sample(const Place& place) const;
  /// Brings what sample() will look at nearer to the processor.
  void fetch(const Place& place) const;

  /// Whether both have the same places.
  [[nodiscard]] bool is_laid_out_as(const TextureMap& other) const;

  static constexpr int kMaxProbes = 8;

 private:
  [[nodiscard]] std::size_t level_count() const { return levels_.size() + 1; }
  [[nodiscard]] DVec2 level_size(std::size_t level) const;
  [[nodiscard]] DVec4 filtered(std::size_t level, Filter filter, const DVec2& uv) const;
  /// At a footprint of so many pixels of the image, above 1.
  [[nodiscard]] DVec4 minified(const DVec2& uv, double width) const;

  std::shared_ptr<const TexturePyramid> pyramid_;
  const Image& image_;
  Sampler sampler_;
  std::span<const float> color_table_, alpha_table_;  // the pyramid's
  std::span<const TexturePyramid::Level> levels_;     // those the sampler asks for
  const void* image_samples_;                         // of the image, 8 or 16 bits each
  bool is_wide_;
};

}  // namespace microtrace
