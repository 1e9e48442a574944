#include "io/image/ktx2_colors.hpp"

#include <cstddef>
#include <cstdint>

namespace microtrace::io {

std::optional<Ktx2Colors> read_ktx2_colors(std::string_view bytes) {
  const auto byte = [bytes](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  constexpr std::size_t descriptor_offset = 48;  // offset in the header
  if (bytes.size() < descriptor_offset + 4) return std::nullopt;
  std::size_t at = 0;
  for (std::size_t i = 4; i-- > 0;) at = at << 8U | byte(descriptor_offset + i);
  constexpr std::size_t transfer = 14, flags = 15;  // byte offsets in the descriptor
  if (at > bytes.size() || bytes.size() - at <= flags) return std::nullopt;

  // Values of the Khronos Data Format Specification.
  constexpr std::uint8_t linear = 1, srgb = 2, premultiplied = 1;
  Ktx2Colors colors{.is_premultiplied = (byte(at + flags) & premultiplied) != 0};
  if (byte(at + transfer) == linear) colors.encoding = ColorEncoding::linear;
  if (byte(at + transfer) == srgb) colors.encoding = ColorEncoding::srgb;
  return colors;
}

}  // namespace microtrace::io
