#include "modules/codecs/basis/uastc_mode.hpp"

#include <array>

namespace basis {
namespace {

constexpr auto kRgb = Channels::rgb, kRgba = Channels::rgba, kLa = Channels::luminance_alpha;

// The tables of modes and of their bits in the "UASTC LDR 4x4 Texture Specification".
constexpr std::array<UastcMode, 19> kModes = {{
    {0b0001, 4, kRgb, 1, 1, 4, {3, 6}, 15},   {0b110101, 6, kRgb, 1, 1, 2, {1, 8}, 15},
    {0b11101, 5, kRgb, 2, 1, 3, {1, 4}, 15},  {0b00011, 5, kRgb, 3, 1, 2, {3, 2}, 15},
    {0b10011, 5, kRgb, 2, 1, 2, {5, 3}, 15},  {0b01011, 5, kRgb, 1, 1, 3, {1, 8}, 15},
    {0b11011, 5, kRgb, 1, 2, 2, {5, 5}, 15},  {0b00111, 5, kRgb, 2, 1, 2, {5, 3}, 15},
    {0b10111, 5, kRgba, 0, 0, 0, {1, 8}, 0},  {0b01111, 5, kRgba, 2, 1, 2, {1, 4}, 23},
    {0b010, 3, kRgba, 1, 1, 4, {3, 4}, 17},   {0b00, 2, kRgba, 1, 2, 2, {3, 4}, 17},
    {0b110, 3, kRgba, 1, 1, 3, {3, 6}, 17},   {0b11111, 5, kRgba, 1, 2, 1, {1, 8}, 23},
    {0b01101, 5, kRgba, 1, 1, 2, {1, 8}, 23}, {0b0000101, 7, kLa, 1, 1, 4, {1, 8}, 23},
    {0b010101, 6, kLa, 2, 1, 2, {1, 8}, 23},  {0b100101, 6, kLa, 1, 2, 2, {1, 8}, 23},
    {0b1001, 4, kRgb, 1, 1, 5, {1, 5}, 15},
}};

constexpr unsigned kLongestCode = 7;

/// Makes the table of modes by the first bits of a block. It contains kModes.size() for the
/// reserved code.
constexpr std::array<std::uint8_t, 1U << kLongestCode> make_lookup() {
  std::array<std::uint8_t, 1U << kLongestCode> kLookup{};
  kLookup.fill(kModes.size());
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    for (std::size_t code = kModes[i].code; code < kLookup.size();
         code += std::size_t{1} << kModes[i].code_length) {
      kLookup[code] = static_cast<std::uint8_t>(i);
    }
  }
  return kLookup;
}
constexpr auto kLookup = make_lookup();

}  // namespace

std::size_t read_uastc_mode(BitReader& bits) {
  const std::size_t index = kLookup[bits.peek(kLongestCode)];
  if (index == kModes.size()) throw Damage("a UASTC block has a reserved mode");
  bits.skip(kModes[index].code_length);
  return index;
}

const UastcMode& uastc_mode(std::size_t index) {
  return kModes[index];
}

}  // namespace basis
