#include "io/checkpoint/pixel_blocks.hpp"

#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <type_traits>

namespace microtrace::io {
namespace {

/// Calls f(number) for each number of a pixel, in file order.
template <class Pixel, class F>
void for_each_number(Pixel& pixel, const F& f) {
  for (auto& channel : pixel.color) {
    for (auto& word : channel.words) f(word);
  }
  for (auto& word : pixel.alpha.words) f(word);
  for (auto& word : pixel.square.words) f(word);
  f(pixel.count);
}

}  // namespace

BlockWriter::BlockWriter() {
  const ModuleFunction function = find_module_function(kCodecModuleFileName, kCompressName);
  compress_ = reinterpret_cast<MicrotraceCompress>(function.address);
}

std::string_view BlockWriter::encode(std::span<const PixelSum> pixels) {
  planes_.resize(pixels.size() * kPixelBytes);
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    std::size_t at = pixel;
    for_each_number(pixels[pixel], [&](auto number) {
      for (std::size_t byte = 0; byte < sizeof number; ++byte, at += pixels.size())
        planes_[at] = static_cast<char>(static_cast<unsigned char>(number >> (8 * byte)));
    });
  }
  if (compress_ == nullptr) return planes_;
  compressed_.resize(planes_.size());
  const std::size_t size =
      compress_(compressed_.data(), planes_.size() - 1, planes_.data(), planes_.size());
  return size == 0 ? std::string_view(planes_) : std::string_view(compressed_).substr(0, size);
}

bool BlockReader::decode(std::string_view bytes, std::span<PixelSum> pixels) {
  const std::size_t size = pixels.size() * kPixelBytes;
  if (bytes.size() > size) return false;
  if (bytes.size() < size) {
    if (decompress_ == nullptr) {
      const ModuleFunction function = find_module_function(kCodecModuleFileName, kDecompressName);
      if (function.address == nullptr) {
        throw Error(ErrorKind::unsupported, path_.string(),
                    "is compressed and can't be read: " + function.complaint +
                        "; build the target microtrace_codecs or set MICROTRACE_MODULE_PATH to "
                        "its folder");
      }
      decompress_ = reinterpret_cast<MicrotraceDecompress>(function.address);
    }
    planes_.resize(size);
    if (decompress_(planes_.data(), size, bytes.data(), bytes.size()) != 1) return false;
    bytes = planes_;
  }
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    std::size_t at = pixel;
    for_each_number(pixels[pixel], [&](auto& number) {
      using Number = std::remove_cvref_t<decltype(number)>;
      number = 0;
      for (std::size_t byte = 0; byte < sizeof number; ++byte, at += pixels.size())
        number |= static_cast<Number>(static_cast<unsigned char>(bytes[at])) << (8 * byte);
    });
  }
  return true;
}

}  // namespace microtrace::io
