#include "io/checkpoint/pixel_blocks.hpp"

#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <bit>
#include <cstdint>
#include <type_traits>

namespace microtrace::io {
namespace {

/// Calls f(number) for each number of a pixel's value, in file order.
template <class Sum, class F>
void for_each_number(Sum& pixel, const F& f) {
  for (auto& channel : pixel.color) {
    for (auto& word : channel.words) f(word);
  }
  for (auto& word : pixel.alpha.words) f(word);
  for (auto& word : pixel.square.words) f(word);
  f(pixel.count);
}

template <class F>
void for_each_number(const float& value, const F& f) {
  f(std::bit_cast<std::uint32_t>(value));
}

template <class F>
void for_each_number(float& value, const F& f) {
  std::uint32_t bits = 0;
  f(bits);
  value = std::bit_cast<float>(bits);
}

template <class F>
void for_each_number(const std::uint32_t& value, const F& f) {
  f(value);
}

template <class F>
void for_each_number(std::uint32_t& value, const F& f) {
  f(value);
}

/// The number of bytes of a value in a block.
template <class Value>
std::size_t size_of_value() {
  std::size_t size = 0;
  const Value value{};
  for_each_number(value, [&](auto number) { size += sizeof number; });
  return size;
}

}  // namespace

BlockWriter::BlockWriter() {
  const ModuleFunction function = find_module_function(kCodecModuleFileName, kCompressName);
  compress_ = reinterpret_cast<MicrotraceCompress>(function.address);
}

template <class Value>
std::string_view BlockWriter::encode(std::span<const Value> block) {
  planes_.resize(block.size() * size_of_value<Value>());
  for (std::size_t pixel = 0; pixel < block.size(); ++pixel) {
    std::size_t at = pixel;
    for_each_number(block[pixel], [&](auto number) {
      for (std::size_t byte = 0; byte < sizeof number; ++byte, at += block.size())
        planes_[at] = static_cast<char>(static_cast<unsigned char>(number >> (8 * byte)));
    });
  }
  if (compress_ == nullptr) return planes_;
  compressed_.resize(planes_.size());
  const std::size_t size =
      compress_(compressed_.data(), planes_.size() - 1, planes_.data(), planes_.size());
  return size == 0 ? std::string_view(planes_) : std::string_view(compressed_).substr(0, size);
}

template <class Value>
bool BlockReader::decode(std::string_view bytes, std::span<Value> block) {
  const std::size_t size = block.size() * size_of_value<Value>();
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
  for (std::size_t pixel = 0; pixel < block.size(); ++pixel) {
    std::size_t at = pixel;
    for_each_number(block[pixel], [&](auto& number) {
      using Number = std::remove_cvref_t<decltype(number)>;
      number = 0;
      for (std::size_t byte = 0; byte < sizeof number; ++byte, at += block.size())
        number |= static_cast<Number>(static_cast<unsigned char>(bytes[at])) << (8 * byte);
    });
  }
  return true;
}

template std::string_view BlockWriter::encode(std::span<const PixelSum>);
template std::string_view BlockWriter::encode(std::span<const float>);
template std::string_view BlockWriter::encode(std::span<const std::uint32_t>);
template bool BlockReader::decode(std::string_view, std::span<PixelSum>);
template bool BlockReader::decode(std::string_view, std::span<float>);
template bool BlockReader::decode(std::string_view, std::span<std::uint32_t>);

}  // namespace microtrace::io
