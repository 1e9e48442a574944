#pragma once
/// How blocks of several subsets are divided.

#include <array>
#include <cstddef>
#include <cstdint>

namespace basis {

struct Pattern {
  std::array<std::uint8_t, 16> subset{};  ///< of each texel
  std::array<bool, 16> is_anchor{};       ///< first texel of a subset, whose weight lacks a bit
};

/// Bits of a pattern's number in blocks of so many subsets, 1 to 3.
[[nodiscard]] unsigned pattern_bits(unsigned subsets);

/// Throws Damage where there is no pattern of that number.
[[nodiscard]] const Pattern& pattern(std::size_t mode, unsigned subsets, std::size_t number);

}  // namespace basis
