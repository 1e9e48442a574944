#pragma once
/// Random input for shading kernels, and bitwise comparison of their output.

#include "render/lanes/shading_kernels.hpp"
#include "simd/vector3.hpp"

#include <bit>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace microtrace {

inline constexpr int kRounds = 500;

class LaneRandom {
 public:
  explicit LaneRandom(unsigned seed) : engine_(seed) {}
  float number() { return static_cast<float>(engine_() >> 8U) * 0x1p-24F; }
  float signed_unit() { return 2 * number() - 1; }
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  Vec3 vector() { return {signed_unit(), signed_unit(), signed_unit()}; }
  Vec3 color() { return {number(), number(), number()}; }
  Vec3 direction() { return unit<1>(vector() + Vec3(0, 0, 1e-3F)); }
  /// Returns a random direction on the side of the plane to which its normal n points.
  Vec3 above(const Vec3& n) {
    const Vec3 w = direction();
    return glm::dot(w, n) < 0 ? -w : w;
  }

 private:
  std::mt19937 engine_;
};

/// Expects equal bits. All NaNs are equal.
inline void expect_bits(float a, float b, const char* what) {
  if (std::isnan(a) && std::isnan(b)) return;
  ASSERT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b))
      << what << ": " << a << " instead of " << b;
}
template <std::size_t count>
void expect_bits(const LaneFloats (&a)[count], const LaneFloats (&b)[count], int lane,
                 const char* what) {
  for (std::size_t k = 0; k < count; ++k) expect_bits(a[k][lane], b[k][lane], what);
}

}  // namespace microtrace
