#pragma once
/// What the first bytes of an image file say, without decoding it.

#include <cstdint>
#include <string_view>

namespace microtrace::io {

enum class ImageFormat { unknown, png, jpeg, webp, ktx2 };

struct ImageHeader {
  ImageFormat format = ImageFormat::unknown;
  /// The header is whole, the file ends within it, or it says nonsense; only a whole one has a
  /// size.
  enum class State { whole, cut_off, damaged } state = State::whole;
  std::uint32_t width = 0, height = 0;
};

/// Of a whole file.
[[nodiscard]] ImageHeader read_image_header(std::string_view bytes);

}  // namespace microtrace::io
