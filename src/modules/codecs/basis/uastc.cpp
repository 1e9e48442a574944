#include "modules/codecs/basis/uastc.hpp"

#include "modules/codecs/basis/uastc_endpoints.hpp"
#include "modules/codecs/basis/uastc_patterns.hpp"

#include <array>

namespace basis {
namespace {

using Ends = std::array<Color, 2>;

/// Computes endpoint colors by ASTC's endpoint modes 8, 12 and 4, without blue contraction.
std::array<Ends, 3> make_ends(const UastcMode& mode,
                              const std::array<std::uint8_t, kMaxEndpointValues>& values) {
  std::array<Ends, 3> result{};
  for (std::size_t subset = 0; subset < mode.subsets; ++subset) {
    const std::uint8_t* v = values.data() + subset * mode.endpoint_values();
    for (std::size_t end = 0; end < 2; ++end, ++v) {
      Color& color = result[subset][end];
      if (mode.channels == Channels::luminance_alpha) {
        color = {v[0], v[0], v[0], v[2]};
      } else {
        color = {v[0], v[2], v[4], mode.channels == Channels::rgba ? v[6] : std::uint8_t{255}};
      }
    }
  }
  return result;
}

/// Converts a weight without trits or quints to the range 0 to 64 (ASTC, section "Weight
/// Unquantization").
std::uint32_t unquantize_weight(std::uint32_t value, unsigned bits) {
  std::uint32_t result = value << (6 - bits);
  for (unsigned size = bits; size < 6; size *= 2) result |= result >> size;
  return result > 32 ? result + 1 : result;
}

/// Interpolates linear channels to 8 bits (ASTC, section "Weight Application").
std::uint8_t mix(std::uint32_t from, std::uint32_t to, std::uint32_t weight) {
  return static_cast<std::uint8_t>((from * 257 * (64 - weight) + to * 257 * weight + 32) >> 14U);
}

}  // namespace

Block decode_uastc_block(Bytes bytes) {
  BitReader bits(bytes);
  const std::size_t index = read_uastc_mode(bits);
  const UastcMode& mode = uastc_mode(index);
  Block block;
  if (mode.subsets == 0) {
    Color color{};
    for (std::uint8_t& channel : color) channel = static_cast<std::uint8_t>(bits.read(8));
    block.fill(color);
    return block;
  }

  bits.skip(mode.hint_bits);
  // The channel that uses the second plane's weights; 4 if there is no second plane.
  std::size_t second = 4;
  if (mode.planes == 2) second = mode.channels == Channels::luminance_alpha ? 3 : bits.read(2);
  const Pattern& parts = pattern(index, mode.subsets, bits.read(pattern_bits(mode.subsets)));
  const std::array<Ends, 3> ends = make_ends(
      mode, read_endpoint_values(bits, mode.range, mode.subsets * mode.endpoint_values()));
  for (std::size_t i = 0; i < 16; ++i) {
    const unsigned size = parts.is_anchor[i] ? mode.weight_bits - 1 : mode.weight_bits;
    std::array<std::uint32_t, 2> weights{};
    for (std::size_t plane = 0; plane < mode.planes; ++plane) {
      weights[plane] = unquantize_weight(bits.read(size), mode.weight_bits);
    }
    const auto& [from, to] = ends[parts.subset[i]];
    for (std::size_t c = 0; c < 4; ++c) {
      block[i][c] = mix(from[c], to[c], weights[c == second ? 1 : 0]);
    }
  }
  return block;
}

}  // namespace basis
