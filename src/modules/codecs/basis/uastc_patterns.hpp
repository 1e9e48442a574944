#pragma once
/// Partition of blocks into subsets.

#include <array>
#include <cstddef>
#include <cstdint>

namespace basis {

struct Pattern {
  std::array<std::uint8_t, 16> subset{};  ///< of each texel
  std::array<bool, 16> is_anchor{};  ///< first texel of a subset, whose weight has one bit less
};

/// Number of bits of a pattern's index in blocks with this many subsets, 1 to 3.
[[nodiscard]] unsigned pattern_bits(unsigned subsets);

/// Throws Damage if there is no pattern with this number.
[[nodiscard]] const Pattern& pattern(std::size_t mode, unsigned subsets, std::size_t number);

}  // namespace basis
