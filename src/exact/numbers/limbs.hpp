#pragma once
/// What exact numbers of fixed and of any width have in common: limbs of 64 bits, and the leading
/// bits of a magnitude, from which bounds in float64 are made.

#include <bit>
#include <cstdint>

namespace microtrace::exact {

/// Two limbs.
__extension__ using Wide = unsigned __int128;

/// A magnitude's leading bits: |x| = (mantissa + delta) 2^exponent, 1/2 <= mantissa < 1 of 53 bits,
/// and 0 <= delta < 2^-53.
struct Leading {
  double mantissa;
  int exponent;
};

/// Of a magnitude with the highest limb `first`, not zero, which ends at 2^top, and the next below.
[[nodiscard]] inline Leading leading_of(std::uint64_t first, std::uint64_t second, int top) {
  const int zeros = std::countl_zero(first);
  const std::uint64_t bits = zeros == 0 ? first : first << zeros | second >> (64 - zeros);
  constexpr int dropped = 64 - 53;
  return {static_cast<double>(bits >> dropped) * 0x1p-53, top - zeros};
}

}  // namespace microtrace::exact
