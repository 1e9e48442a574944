#include "modules/codecs/basis/uastc_mode.hpp"

#include <array>

namespace basis {
namespace {

constexpr auto rgb = Channels::rgb, rgba = Channels::rgba, la = Channels::luminance_alpha;

// The tables of modes and of their bits in the "UASTC LDR 4x4 Texture Specification".
constexpr std::array<UastcMode, 19> modes = {{
    {0b0001, 4, rgb, 1, 1, 4, {3, 6}, 15},   {0b110101, 6, rgb, 1, 1, 2, {1, 8}, 15},
    {0b11101, 5, rgb, 2, 1, 3, {1, 4}, 15},  {0b00011, 5, rgb, 3, 1, 2, {3, 2}, 15},
    {0b10011, 5, rgb, 2, 1, 2, {5, 3}, 15},  {0b01011, 5, rgb, 1, 1, 3, {1, 8}, 15},
    {0b11011, 5, rgb, 1, 2, 2, {5, 5}, 15},  {0b00111, 5, rgb, 2, 1, 2, {5, 3}, 15},
    {0b10111, 5, rgba, 0, 0, 0, {1, 8}, 0},  {0b01111, 5, rgba, 2, 1, 2, {1, 4}, 23},
    {0b010, 3, rgba, 1, 1, 4, {3, 4}, 17},   {0b00, 2, rgba, 1, 2, 2, {3, 4}, 17},
    {0b110, 3, rgba, 1, 1, 3, {3, 6}, 17},   {0b11111, 5, rgba, 1, 2, 1, {1, 8}, 23},
    {0b01101, 5, rgba, 1, 1, 2, {1, 8}, 23}, {0b0000101, 7, la, 1, 1, 4, {1, 8}, 23},
    {0b010101, 6, la, 2, 1, 2, {1, 8}, 23},  {0b100101, 6, la, 1, 2, 2, {1, 8}, 23},
    {0b1001, 4, rgb, 1, 1, 5, {1, 5}, 15},
}};

constexpr unsigned longest_code = 7;

/// Modes by the first bits of a block; modes.size() for the reserved code.
constexpr std::array<std::uint8_t, 1U << longest_code> make_lookup() {
  std::array<std::uint8_t, 1U << longest_code> lookup{};
  lookup.fill(modes.size());
  for (std::size_t i = 0; i < modes.size(); ++i) {
    for (std::size_t code = modes[i].code; code < lookup.size();
         code += std::size_t{1} << modes[i].code_length) {
      lookup[code] = static_cast<std::uint8_t>(i);
    }
  }
  return lookup;
}
constexpr auto lookup = make_lookup();

}  // namespace

std::size_t read_uastc_mode(BitReader& bits) {
  const std::size_t index = lookup[bits.peek(longest_code)];
  if (index == modes.size()) throw Damage("a UASTC block has a reserved mode");
  bits.skip(modes[index].code_length);
  return index;
}

const UastcMode& uastc_mode(std::size_t index) {
  return modes[index];
}

}  // namespace basis
