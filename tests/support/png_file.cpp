#include "support/png_file.hpp"

#include <cstddef>
#include <string_view>

namespace microtrace::tests {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
  return bytes;
}

std::uint32_t crc(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

std::string chunk(const PngChunk& chunk) {
  const std::string body = chunk.name + chunk.data;
  return big_endian(static_cast<std::uint32_t>(chunk.data.size())) + body + big_endian(crc(body));
}

/// Returns a zlib stream of uncompressed blocks (RFC 1950 and 1951).
std::string stored(std::string_view bytes) {
  std::string result = "\x78\x01";
  std::uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  do {
    const std::string_view block = bytes.substr(0, 65535);
    bytes.remove_prefix(block.size());
    const auto size = static_cast<std::uint32_t>(block.size());
    result += bytes.empty() ? '\1' : '\0';
    for (const std::uint32_t number : {size, ~size}) {
      result += static_cast<char>(number & 0xFFU);
      result += static_cast<char>(number >> 8U & 0xFFU);
    }
    result += block;
  } while (!bytes.empty());
  return result + big_endian(b << 16U | a);
}

}  // namespace

std::string png_file(const PngPicture& picture) {
  std::string header = big_endian(picture.width) + big_endian(picture.height);
  header += static_cast<char>(picture.depth);
  header += static_cast<char>(picture.color);
  header += std::string(3, '\0');
  std::string pixels;
  for (const std::string& row : picture.rows) pixels += '\0' + row;
  std::string file = "\x89PNG\r\n\x1a\n" + chunk({"IHDR", header});
  for (const PngChunk& extra : picture.before_pixels) file += chunk(extra);
  return file + chunk({"IDAT", stored(pixels)}) + chunk({"IEND", ""});
}

std::string png_of(std::uint32_t width, std::uint32_t height,
                   const std::vector<std::uint8_t>& rgba) {
  PngPicture picture{.width = width, .height = height};
  const std::size_t stride = std::size_t{width} * 4;
  for (std::size_t y = 0; y < height; ++y) {
    picture.rows.emplace_back(reinterpret_cast<const char*>(rgba.data()) + y * stride, stride);
  }
  return png_file(picture);
}

}  // namespace microtrace::tests
