#include "io/image/decode/ktx2_colors.hpp"

#include <cstddef>
#include <cstdint>

namespace microtrace::io {

std::optional<Ktx2Colors> read_ktx2_colors(std::string_view bytes) {
  const auto byte = [bytes](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  constexpr std::size_t kDescriptorOffset = 48;  // position in the file header
  if (bytes.size() < kDescriptorOffset + 4) return std::nullopt;
  std::size_t at = 0;
  for (std::size_t i = 4; i-- > 0;) at = at << 8U | byte(kDescriptorOffset + i);
  constexpr std::size_t kTransfer = 14, kFlags = 15;  // byte offsets in the descriptor
  if (at > bytes.size() || bytes.size() - at <= kFlags) return std::nullopt;

  // Constants of the Khronos Data Format Specification.
  constexpr std::uint8_t kLinear = 1, kSrgb = 2, kPremultiplied = 1;
  Ktx2Colors colors{.is_premultiplied = (byte(at + kFlags) & kPremultiplied) != 0};
  if (byte(at + kTransfer) == kLinear) colors.encoding = ColorEncoding::linear;
  if (byte(at + kTransfer) == kSrgb) colors.encoding = ColorEncoding::srgb;
  return colors;
}

}  // namespace microtrace::io
