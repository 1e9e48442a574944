#pragma once
/// Functions that fixed-width and arbitrary-width exact numbers share: decoding of floating-point
/// numbers into 64-bit limbs, and the leading bits of a magnitude, from which float64 bounds are
/// computed.

#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace microtrace::exact {

/// An unsigned integer of two limbs.
__extension__ using Wide = unsigned __int128;

/// The parts of a finite float32 or float64 number: |x| = mantissa 2^exponent. Infinities and NaN
/// are decoded as if finite numbers continued with the next larger exponent.
struct Decoded {
  bool negative;
  std::uint64_t mantissa;
  int exponent;
};
template <std::floating_point Float>
[[nodiscard]] Decoded decode(Float x) {
  using Bits = std::conditional_t<sizeof(Float) == 4, std::uint32_t, std::uint64_t>;
  constexpr int kFractionBits = std::numeric_limits<Float>::digits - 1;
  constexpr int kLeast = std::numeric_limits<Float>::min_exponent - 1 - kFractionBits;
  constexpr Bits kHidden = Bits{1} << kFractionBits;
  const Bits bits = std::bit_cast<Bits>(x), magnitude = bits & ~Bits{0} >> 1;
  const Bits fraction = magnitude & (kHidden - 1);
  const int biased = static_cast<int>(magnitude >> kFractionBits);
  if (biased == 0) return {bits != magnitude, fraction, kLeast};
  return {bits != magnitude, fraction | kHidden, kLeast - 1 + biased};
}

/// The leading bits of a magnitude: |x| = (mantissa + delta) 2^exponent, where mantissa has 53
/// bits, 1/2 <= mantissa < 1, and 0 <= delta < 2^-53.
struct Leading {
  double mantissa;
  int exponent;
};

/// Returns the leading bits of a magnitude whose highest limb is `first`, which must be nonzero,
/// and whose next limb is `second`. 2^top is the weight of the bit just above `first`.
[[nodiscard]] inline Leading leading_of(std::uint64_t first, std::uint64_t second, int top) {
  const int zeros = std::countl_zero(first);
  const std::uint64_t bits = zeros == 0 ? first : first << zeros | second >> (64 - zeros);
  constexpr int kDropped = 64 - 53;
  return {static_cast<double>(bits >> kDropped) * 0x1p-53, top - zeros};
}

}  // namespace microtrace::exact
