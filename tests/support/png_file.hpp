#pragma once
/// Writes uncompressed PNG files in memory. Tests thus know every pixel.

#include <cstdint>
#include <string>
#include <vector>

namespace microtrace::tests {

enum class PngColor : std::uint8_t {
  gray = 0,
  rgb = 2,
  palette = 3,
  gray_alpha = 4,
  rgb_alpha = 6
};

struct PngChunk {
  std::string name, data;
};

struct PngPicture {
  std::uint32_t width = 1, height = 1;
  std::uint8_t depth = 8;  ///< bits per sample
  PngColor color = PngColor::rgb_alpha;
  std::vector<std::string> rows{};  ///< the bytes of each row; samples of 16 bits are big-endian
  std::vector<PngChunk> before_pixels{};  ///< PLTE, tRNS, gAMA and other chunks
};

[[nodiscard]] std::string png_file(const PngPicture& picture);

/// Returns a PNG file with four channels of eight bits.
[[nodiscard]] std::string png_of(std::uint32_t width, std::uint32_t height,
                                 const std::vector<std::uint8_t>& rgba);

}  // namespace microtrace::tests
