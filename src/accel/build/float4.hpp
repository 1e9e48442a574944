#pragma once
/// Four floats in the portable vector extension of GCC and Clang. The builder stores a box as two
/// of these vectors. The fourth lane carries other data and is never used as a number.

#include <bit>
#include <cstdint>
#include <limits>

namespace microtrace::build {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using UInt4 = std::uint32_t __attribute__((vector_size(16)));

[[nodiscard]] inline Float4 min(Float4 a, Float4 b) {
  return a < b ? a : b;
}
[[nodiscard]] inline Float4 max(Float4 a, Float4 b) {
  return a > b ? a : b;
}
[[nodiscard]] inline Float4 splat(float x) {
  return Float4{x, x, x, x};
}

/// Sets the fourth lane to 0, because its data could be the bits of a subnormal number, with which
/// arithmetic is slow.
[[nodiscard]] inline Float4 xyz(Float4 v) {
  return std::bit_cast<Float4>(std::bit_cast<Int4>(v) & Int4{-1, -1, -1, 0});
}

/// An axis-aligned, closed box; empty if lo > hi.
struct Box {
  Float4 lo = splat(std::numeric_limits<float>::infinity());
  Float4 hi = splat(-std::numeric_limits<float>::infinity());

  void include(const Box& b) {
    lo = min(lo, b.lo);
    hi = max(hi, b.hi);
  }
  void include(Float4 p) {
    lo = min(lo, p);
    hi = max(hi, p);
  }
};

/// Returns half of each extent, because the full extent could exceed the largest float.
[[nodiscard]] inline Float4 half_extent(const Box& b) {
  return xyz(b.hi) * splat(0.5F) - xyz(b.lo) * splat(0.5F);
}

}  // namespace microtrace::build
