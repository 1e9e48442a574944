#pragma once
/// Writes PNG (ISO/IEC 15948) by the codec module, which is loaded when needed.

#include "io/image/codec_abi.hpp"

#include <microtrace/film.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace microtrace::io {

class PngEncoder {
 public:
  enum class Speed {
    small_files,
    fast,  ///< several times as fast, for larger files with the same samples
  };

  /// Loads the module. Messages name `file`. Throws an Error(unsupported) that lists the searched
  /// folders.
  explicit PngEncoder(std::string file, Speed speed = Speed::small_files);

  /// Passes the file to `out` in parts. It has 8 bits per sample according to the film's display
  /// settings, and alpha if the film has it. Throws the exceptions of `out`, and Error: limit if
  /// memory runs out, else io.
  void encode(const Film& film, const std::function<void(std::string_view)>& out) const;

  /// Encodes a picture whose description lacks the callbacks. `row` returns the samples of a row.
  /// Otherwise like the other encode().
  void encode(MicrotracePng picture, const std::function<const void*(std::uint32_t y)>& row,
              const std::function<void(std::string_view)>& out) const;

 private:
  std::string file_;
  Speed speed_;
  MicrotraceEncodePng encode_ = nullptr;
};

/// Returns a gray picture of 8 or 16 bits per sample as a PNG file, without a color space. The
/// samples are in rows. Throws Error: unsupported if there is no codec module, io if the picture is
/// too large for PNG.
[[nodiscard]] std::string encode_gray_png(ImageSize size, std::span<const std::uint8_t> samples);
[[nodiscard]] std::string encode_gray_png(ImageSize size, std::span<const std::uint16_t> samples);

}  // namespace microtrace::io
