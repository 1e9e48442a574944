#pragma once
/// Encodes values of pixels (PixelSum, float or std::uint32_t) in blocks, which are compressed by
/// the module of codecs.
///
/// A block holds the values of up to kBlockPixels pixels: first the lowest byte of the first number
/// of every pixel, then the next byte, and so on. Bytes of equal significance are similar in
/// neighboring pixels, so they compress better side by side.

#include "io/image/codec_abi.hpp"

#include <microtrace/sample_sums.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace microtrace::io {

inline constexpr std::size_t kBlockPixels = 4096;

/// Calls f(block) for each block of these values.
template <class Value, class F>
void for_each_block(std::span<Value> values, const F& f) {
  for (; !values.empty(); values = values.subspan(std::min(values.size(), kBlockPixels)))
    f(values.first(std::min(values.size(), kBlockPixels)));
}

class BlockWriter {
 public:
  BlockWriter();

  /// Encodes a block. The result is valid until the next call. It has all bytes of the values if
  /// the block is not compressed, either because that wouldn't make it smaller or because there is
  /// no module, else fewer.
  template <class Value>
  [[nodiscard]] std::string_view encode(std::span<const Value> block);

 private:
  MicrotraceCompress compress_ = nullptr;
  std::string planes_{}, compressed_{};
};

class BlockReader {
 public:
  /// `path` is the file that is read, for messages.
  explicit BlockReader(std::filesystem::path path) : path_(std::move(path)) {}

  /// Decodes a block into these values. Returns false if it is damaged. Throws Error (unsupported)
  /// if it is compressed and there is no module.
  template <class Value>
  [[nodiscard]] bool decode(std::string_view bytes, std::span<Value> block);

 private:
  std::filesystem::path path_;
  MicrotraceDecompress decompress_ = nullptr;
  std::string planes_{};
};

}  // namespace microtrace::io
