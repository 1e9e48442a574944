#pragma once
/// Encodes the sums of pixels in blocks, which are compressed by the module of codecs.
///
/// A block holds the sums of up to kBlockPixels pixels: first the lowest byte of the first number
/// of every pixel, then the next byte, and so on. Bytes of equal significance are similar in
/// neighboring pixels, so they compress better side by side.

#include "io/image/codec_abi.hpp"

#include <microtrace/sample_sums.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace microtrace::io {

inline constexpr std::size_t kBlockPixels = 4096;
inline constexpr std::size_t kPixelBytes = 10 * 8 + 4;

class BlockWriter {
 public:
  BlockWriter();

  /// Encodes the pixels of a block. The result is valid until the next call. It has kPixelBytes per
  /// pixel if the block is not compressed, either because that wouldn't make it smaller or because
  /// there is no module, else fewer.
  [[nodiscard]] std::string_view encode(std::span<const PixelSum> pixels);

 private:
  MicrotraceCompress compress_ = nullptr;
  std::string planes_{}, compressed_{};
};

class BlockReader {
 public:
  /// `path` is the file that is read, for messages.
  explicit BlockReader(std::filesystem::path path) : path_(std::move(path)) {}

  /// Decodes a block into these pixels. Returns false if it is damaged. Throws Error (unsupported)
  /// if it is compressed and there is no module.
  [[nodiscard]] bool decode(std::string_view bytes, std::span<PixelSum> pixels);

 private:
  std::filesystem::path path_;
  MicrotraceDecompress decompress_ = nullptr;
  std::string planes_{};
};

}  // namespace microtrace::io
