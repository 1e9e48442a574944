#pragma once
/// Texture lookups.

#include "render/lanes/texels.hpp"
#include "render/textures/read_texel.hpp"
#include "render/textures/texel_address.hpp"
#include "render/textures/texture_pyramid.hpp"

#include <microtrace/math.hpp>
#include <microtrace/texture.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace microtrace {

/// The change of the texture coordinates from one sample of the picture to the next: to the right
/// in dx, and down in dy.
struct TextureFootprint {
  DVec2 dx{0}, dy{0};
};

/// An image with a sampler, ready for lookups. All filtering is in linear light, with alpha
/// separate from color.
class TextureMap {
 public:
  /// Uses this pyramid, and makes it compute its mip maps if the sampler uses them.
  TextureMap(const std::shared_ptr<TexturePyramid>& pyramid, const Sampler& sampler);

  /// Creates a pyramid for this map only. The image must outlive this object.
  TextureMap(const Image& image, const Sampler& sampler, ColorEncoding encoding);

  /// The color at uv, where (0, 0) is the upper left corner of the image and (1, 1) the lower right
  /// corner. If texels are larger than the footprint, uses the magnification filter. Otherwise uses
  /// the minification filter with up to kMaxProbes lookups along the longer axis of the footprint,
  /// which keeps textures of oblique surfaces sharp.
  [[nodiscard]] DVec4 look_up(const DVec2& uv, const TextureFootprint& footprint) const;

  /// The color at uv in float32, for Monte Carlo samples, which filter the texture by averaging.
  /// Does one bilinear lookup in the mip level whose texels are just smaller than `width`, given as
  /// a fraction of the image's size.
  [[nodiscard]] Vec4 sample(const Vec2& uv, float width) const {
    return sample(texel_address(uv, width));
  }

  /// The address of the texels that sample() reads.
  [[nodiscard]] TexelAddress<1> texel_address(const Vec2& uv, float width) const {
    return microtrace::texel_address<1>(grid_, uv.x, uv.y, width);
  }
  [[nodiscard]] Vec4 sample(const TexelAddress<1>& address) const;
  /// Prefetches the texels at this address.
  void fetch(const TexelAddress<1>& address) const { prefetch_texel(texels(), address); }

  /// True if both maps have equal texel addresses for equal texture coordinates.
  [[nodiscard]] bool is_laid_out_as(const TextureMap& other) const { return grid_ == other.grid_; }
  [[nodiscard]] const TexelGrid& grid() const { return grid_; }
  /// Valid as long as this object.
  [[nodiscard]] Texels texels() const {
    return {.levels = level_samples_.data(),
            .color = color_table_.data(),
            .alpha = alpha_table_.data(),
            .channels = image_.channels,
            .is_wide = is_wide_};
  }

  [[nodiscard]] const Image& image() const { return image_; }
  [[nodiscard]] const Sampler& sampler() const { return sampler_; }
  /// The alpha that a sample value of the image stands for.
  [[nodiscard]] float alpha(std::uint16_t value) const { return alpha_table_[value]; }

  static constexpr int kMaxProbes = 8;

 private:
  [[nodiscard]] std::size_t level_count() const { return levels_.size() + 1; }
  [[nodiscard]] DVec2 level_size(std::size_t level) const;
  [[nodiscard]] DVec4 filtered(std::size_t level, Filter filter, const DVec2& uv) const;
  /// The color at uv for a footprint that is more than one texel wide.
  [[nodiscard]] DVec4 minified(const DVec2& uv, double width) const;

  std::shared_ptr<const TexturePyramid> pyramid_;
  const Image& image_;
  Sampler sampler_;
  std::span<const float> color_table_, alpha_table_;  // tables of the pyramid
  std::span<const TexturePyramid::Level> levels_;     // the levels that the sampler uses
  bool is_wide_;                                      // true if the image's samples have 16 bits
  std::vector<const void*> level_samples_;            // of the image and of these levels
  TexelGrid grid_;
};

}  // namespace microtrace
