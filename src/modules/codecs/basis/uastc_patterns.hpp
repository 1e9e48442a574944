#pragma once
/// Patterns that partition the texels of a block into subsets.

#include <array>
#include <cstddef>
#include <cstdint>

namespace basis {

struct Pattern {
  std::array<std::uint8_t, 16> subset{};  ///< subset of each texel
  /// True for the first texel of each subset. Weights of these texels have one bit fewer.
  std::array<bool, 16> is_anchor{};
};

/// Number of bits of the pattern number in a block with 1 to 3 subsets.
[[nodiscard]] unsigned pattern_bits(unsigned subsets);

/// Returns the pattern with this number. Throws Damage if there is none.
[[nodiscard]] const Pattern& pattern(std::size_t mode, unsigned subsets, std::size_t number);

}  // namespace basis
