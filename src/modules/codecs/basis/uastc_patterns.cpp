#include "modules/codecs/basis/uastc_patterns.hpp"

#include "modules/codecs/basis/bytes.hpp"
#include "modules/codecs/basis/uastc_mode.hpp"

#include <span>

namespace basis {
namespace {

/// hash52() of the Khronos Data Format Specification, section "Partition Pattern Generation".
constexpr std::uint32_t hash(std::uint32_t p) {
  p ^= p >> 15U;
  p -= p << 17U;
  p += p << 7U;
  p += p << 4U;
  p ^= p >> 5U;
  p += p << 16U;
  p ^= p >> 7U;
  p ^= p >> 3U;
  p ^= p << 6U;
  p ^= p >> 17U;
  return p;
}

/// ASTC's partition pattern for a seed (same section), for blocks of 4 x 4 texels with 2 or 3
/// subsets.
constexpr Pattern make_pattern(std::uint32_t seed, std::uint32_t subsets) {
  seed += (subsets - 1) * 1024;
  const std::uint32_t random = hash(seed);
  const std::uint32_t by_size = subsets == 3 ? 6 : 5, by_seed = (seed & 2U) != 0 ? 4 : 5;
  const bool is_odd = (seed & 1U) != 0;
  const std::uint32_t x_shift = is_odd ? by_seed : by_size, y_shift = is_odd ? by_size : by_seed;
  const auto slope = [&](unsigned at, std::uint32_t shift) {
    const std::uint32_t bits = random >> at & 15U;
    return bits * bits >> shift;
  };
  Pattern result;
  std::array<bool, 3> met{};
  for (std::uint32_t i = 0; i < 16; ++i) {
    // ASTC doubles the coordinates in blocks with fewer than 31 texels.
    const std::uint32_t x = 2 * (i % 4), y = 2 * (i / 4);
    const auto height = [&](unsigned at, unsigned offset) {
      return (slope(at, x_shift) * x + slope(at + 4, y_shift) * y + (random >> offset)) & 63U;
    };
    const std::uint32_t a = height(0, 14), b = height(8, 10);
    const std::uint32_t c = subsets == 3 ? height(16, 6) : 0;
    const std::uint8_t subset = a >= b && a >= c ? 0 : b >= c ? 1 : 2;
    result.subset[i] = subset;
    result.is_anchor[i] = !met[subset];
    met[subset] = true;
  }
  return result;
}

template <std::size_t size>
constexpr std::array<Pattern, size> make_patterns(const std::array<std::uint16_t, size>& seeds,
                                                  std::uint32_t subsets) {
  std::array<Pattern, size> result{};
  for (std::size_t i = 0; i < size; ++i) result[i] = make_pattern(seeds[i], subsets);
  return result;
}

// ASTC seeds of the patterns that ASTC and BC7 have in common ("UASTC LDR 4x4 Texture
// Specification").
constexpr auto kTwoSubsets =
    make_patterns<30>({28, 20,  16,  29, 91,  9,   107, 72,  149, 204, 50,  114, 496, 17,  78,
                       39, 252, 828, 43, 156, 116, 210, 476, 273, 684, 359, 246, 195, 694, 524},
                      2);
constexpr auto kThreeSubsets =
    make_patterns<11>({260, 74, 32, 156, 183, 15, 745, 0, 335, 902, 254}, 3);
/// ASTC patterns with two subsets that match BC7 patterns with three subsets.
constexpr auto kOtherTwoSubsets = make_patterns<19>(
    {36, 48, 61, 137, 161, 183, 226, 281, 302, 307, 479, 495, 593, 594, 605, 799, 812, 988, 993},
    2);
constexpr std::array<Pattern, 1> kOneSubset = {{{{}, {true}}}};

std::span<const Pattern> patterns(std::size_t mode, unsigned subsets) {
  if (mode == kUastcModeOfOtherPatterns) return kOtherTwoSubsets;
  if (subsets == 3) return kThreeSubsets;
  if (subsets == 2) return kTwoSubsets;
  return kOneSubset;
}

}  // namespace

unsigned pattern_bits(unsigned subsets) {
  constexpr std::array<unsigned, 4> kBits = {0, 0, 5, 4};
  return kBits[subsets];
}

const Pattern& pattern(std::size_t mode, unsigned subsets, std::size_t number) {
  const std::span<const Pattern> all = patterns(mode, subsets);
  if (number >= all.size()) throw Damage("a UASTC block has a reserved pattern");
  return all[number];
}

}  // namespace basis
