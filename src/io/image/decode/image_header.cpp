#include "io/image/decode/image_header.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace microtrace::io {
namespace {

std::uint32_t byte(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < size; ++i) result = result << 8U | byte(bytes, at + i);
  return result;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t result = 0;
  for (std::size_t i = size; i-- > 0;) result = result << 8U | byte(bytes, at + i);
  return result;
}

struct Size {
  std::uint32_t width, height;
};
// A size of 0 x 0 marks an invalid header. The functions below return nothing if the file ends too
// early.
constexpr Size kNoSize{0, 0};

/// Reads a PNG header (ISO/IEC 15948, section 11.2.2). The chunk IHDR comes first.
std::optional<Size> png_size(std::string_view bytes) {
  constexpr std::string_view kFirstChunk("\0\0\0\x0dIHDR", 8);
  if (!bytes.substr(8, 8).starts_with(kFirstChunk.substr(0, bytes.size() - 8))) return kNoSize;
  if (bytes.size() < 33) return std::nullopt;
  return Size{big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
}

/// The first marker of a JPEG segment from `at` on, or npos.
std::size_t find_jpeg_segment(std::string_view bytes, std::size_t at) {
  for (; at + 4 <= bytes.size(); ++at) {
    const std::uint32_t marker = byte(bytes, at + 1);
    if (byte(bytes, at) == 0xFF && marker != 0xFF && marker != 0) return at;
  }
  return std::string_view::npos;
}

std::size_t end_of_jpeg_segment(std::string_view bytes, std::size_t at) {
  const std::uint32_t marker = byte(bytes, at + 1);
  const bool alone = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
  return at + (alone ? 2 : 2 + std::max(big_endian(bytes, at + 2, 2), 2U));
}

/// Reads a JPEG header (ITU-T T.81, annex B) by following segments up to the frame header SOFn.
/// Skips bytes between segments, like libjpeg. A file that does not start with a segment and has no
/// frame is invalid.
std::optional<Size> jpeg_size(std::string_view bytes) {
  for (std::size_t at = find_jpeg_segment(bytes, 2); at != bytes.npos;
       at = find_jpeg_segment(bytes, end_of_jpeg_segment(bytes, at))) {
    const std::uint32_t marker = byte(bytes, at + 1);
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) {
      if (at + 9 > bytes.size()) return std::nullopt;
      return Size{big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
    }
    if (marker == 0xD9 || marker == 0xDA) return kNoSize;
  }
  if (bytes.size() > 3 && byte(bytes, 3) == 0) return kNoSize;
  return std::nullopt;
}

/// Reads a WebP header (RFC 9649, sections 2.5 to 2.7) in one of its three forms: simple lossy,
/// simple lossless, or extended.
std::optional<Size> webp_size(std::string_view bytes) {
  if (bytes.size() < 25) return std::nullopt;
  const std::string_view kind = bytes.substr(12, 4);
  // A whole lossless picture of one color may have 28 bytes.
  const bool is_whole = kind == "VP8L" && bytes.size() - 20 >= little_endian(bytes, 16, 4);
  if (bytes.size() < 30 && !is_whole) return std::nullopt;
  if (kind == "VP8 ") {
    return Size{little_endian(bytes, 26, 2) & 0x3FFFU, little_endian(bytes, 28, 2) & 0x3FFFU};
  }
  if (kind == "VP8L") {
    const std::uint32_t bits = little_endian(bytes, 21, 4);
    return Size{(bits & 0x3FFFU) + 1, (bits >> 14U & 0x3FFFU) + 1};
  }
  if (kind == "VP8X") return Size{little_endian(bytes, 24, 3) + 1, little_endian(bytes, 27, 3) + 1};
  return kNoSize;
}

/// Reads a KTX2 header and the first entry of the level index (KTX File Format Specification 2.0,
/// section 2).
std::optional<Size> ktx2_size(std::string_view bytes) {
  if (bytes.size() < 104) return std::nullopt;
  return Size{little_endian(bytes, 20, 4), little_endian(bytes, 24, 4)};
}

ImageHeader header(ImageFormat format, const std::optional<Size>& size) {
  using State = ImageHeader::State;
  if (!size) return {.format = format, .state = State::cut_off};
  if (size->width == 0 || size->height == 0) return {.format = format, .state = State::damaged};
  return {.format = format, .width = size->width, .height = size->height};
}

/// A chunk acTL before the first IDAT tells the number of frames (PNG 3, section 11.3.6.1).
bool is_animated_png(std::string_view bytes) {
  constexpr std::size_t kSignature = 8, kBesideData = 12;  // length, name and checksum of a chunk
  std::size_t at = kSignature;
  while (bytes.size() - at >= kBesideData) {
    const std::string_view name = bytes.substr(at + 4, 4);
    if (name == "IDAT") return false;
    if (name == "acTL") return big_endian(bytes, at + 8, 4) > 1;
    at += std::min(std::size_t{big_endian(bytes, at, 4)} + kBesideData, bytes.size() - at);
  }
  return false;
}

/// The chunk VP8X has a flag for animations (RFC 9649, section 2.7).
bool is_animated_webp(std::string_view bytes) {
  return bytes.size() > 20 && bytes.substr(12, 4) == "VP8X" && (byte(bytes, 20) & 2U) != 0;
}

}  // namespace

bool is_animated(std::string_view bytes) {
  const ImageFormat format = read_image_header(bytes).format;
  return (format == ImageFormat::png && is_animated_png(bytes)) ||
         (format == ImageFormat::webp && is_animated_webp(bytes));
}

bool is_cut_off_jpeg(std::string_view bytes) {
  if (!bytes.starts_with("\xff\xd8\xff")) return false;
  std::size_t at = find_jpeg_segment(bytes, 2);
  while (at != bytes.npos && byte(bytes, at + 1) != 0xDA)
    at = find_jpeg_segment(bytes, end_of_jpeg_segment(bytes, at));
  // In the data of a scan, 0xFF is followed by 0.
  return at == bytes.npos || bytes.find("\xff\xd9", at) == bytes.npos;
}

ImageHeader read_image_header(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return header(ImageFormat::png, png_size(bytes));
  if (bytes.starts_with("\xff\xd8\xff")) return header(ImageFormat::jpeg, jpeg_size(bytes));
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) {
    return header(ImageFormat::webp, webp_size(bytes));
  }
  if (bytes.starts_with("\xabKTX 20\xbb\r\n\x1a\n")) {
    return header(ImageFormat::ktx2, ktx2_size(bytes));
  }
  return {};
}

}  // namespace microtrace::io
