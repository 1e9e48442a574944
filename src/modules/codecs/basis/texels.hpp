#pragma once
/// The buffer into which blocks are decoded.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace basis {

using Color = std::array<std::uint8_t, 4>;  ///< red, green, blue, alpha
using Block = std::array<Color, 16>;        ///< 4 x 4 texels, row by row

/// Returns the number of blocks along a side with this many texels.
constexpr std::uint32_t blocks_along(std::uint32_t texels) {
  return texels / 4 + (texels % 4 != 0 ? 1 : 0);
}

/// Rows of 8-bit samples. Blocks are clipped at the right and lower edges.
struct Texels {
  unsigned char* samples;
  std::uint32_t width, height, channels;  ///< channels: 3 or 4

  [[nodiscard]] std::uint32_t blocks_x() const { return blocks_along(width); }
  [[nodiscard]] std::uint32_t blocks_y() const { return blocks_along(height); }

  /// Writes channels `first` to `end` - 1 of a block's texels.
  void set_block(std::uint32_t block_x, std::uint32_t block_y, const Block& block,
                 std::uint32_t first, std::uint32_t end) const {
    const std::uint32_t x0 = 4 * block_x, y0 = 4 * block_y;
    const std::uint32_t columns = std::min(width - x0, 4U), rows = std::min(height - y0, 4U);
    for (std::uint32_t y = 0; y < rows; ++y) {
      unsigned char* texel = samples + (std::size_t{y0 + y} * width + x0) * channels;
      for (std::uint32_t x = 0; x < columns; ++x, texel += channels) {
        const Color& color = block[4 * y + x];
        std::copy(color.begin() + first, color.begin() + end, texel + first);
      }
    }
  }
};

}  // namespace basis
