#pragma once
/// Reads the size of an image from the first bytes of its file, without decoding it.

#include <cstdint>
#include <string_view>

namespace microtrace::io {

enum class ImageFormat { unknown, png, jpeg, webp, ktx2 };

struct ImageHeader {
  ImageFormat format = ImageFormat::unknown;
  /// The state of the header: complete, cut off because the file ends within it, or invalid. Only a
  /// complete header has a size.
  enum class State { whole, cut_off, damaged } state = State::whole;
  std::uint32_t width = 0, height = 0;
};

/// Reads the header of an image. `bytes` must be the whole file.
[[nodiscard]] ImageHeader read_image_header(std::string_view bytes);

/// Returns true for a PNG or WebP file with an animation of several frames.
[[nodiscard]] bool is_animated(std::string_view bytes);

/// True if the bytes begin as a JPEG, but lack its end. Some libraries fill the missing part with
/// gray without an error.
[[nodiscard]] bool is_cut_off_jpeg(std::string_view bytes);

}  // namespace microtrace::io
