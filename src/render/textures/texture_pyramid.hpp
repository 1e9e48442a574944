#pragma once
/// Images with their mip maps, shared by all textures of an image.

#include "base/memory_account.hpp"

#include <microtrace/math.hpp>
#include <microtrace/texture.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace microtrace {

/// An image with a color encoding.
class TexturePyramid {
 public:
  TexturePyramid(std::shared_ptr<const Image> image, ColorEncoding encoding);

  /// A mip map with four channels of linear values.
  struct Level {
    std::uint32_t width, height;
    std::vector<std::uint16_t> samples{};
  };

  [[nodiscard]] const Image& image() const { return *image_; }
  /// The tables that convert sample values to linear values.
  [[nodiscard]] std::span<const float> color_table() const { return color_table_; }
  [[nodiscard]] std::span<const float> alpha_table() const { return alpha_table_; }

  /// The mip maps, starting with level 1. The first call computes them on one thread. Each pixel is
  /// the mean of the part of the finer level that it covers.
  [[nodiscard]] const std::vector<Level>& levels();

  /// A pixel of level 0, which is the image, or of a level that levels() has computed.
  [[nodiscard]] DVec4 pixel(std::size_t level, std::uint32_t x, std::uint32_t y) const;

 private:
  [[nodiscard]] DVec2 level_size(std::size_t level) const;
  [[nodiscard]] DVec4 image_pixel(std::uint32_t x, std::uint32_t y) const;
  void make_levels();
  /// Fills a level that has half the width and height of the finer level, which must be even.
  void halve(std::size_t finer, Level& level) const;

  std::shared_ptr<const Image> image_;
  std::span<const float> color_table_, alpha_table_;
  MemoryAccount memory_;  // memory of the levels, which several scenes may share
  std::vector<Level> levels_;
};

}  // namespace microtrace
