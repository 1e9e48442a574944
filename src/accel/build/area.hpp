#pragma once
#include "accel/build/float4.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <array>
#include <bit>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::build {

/// Returns half the surface area of a box with these extents.
[[nodiscard]] inline double half_area(double x, double y, double z) {
  return x * y + (x + y) * z;
}

/// Computes surface areas in a unit that depends on a box containing all others. A power of two
/// scales the largest length to at most 4. Areas therefore never overflow, and they don't underflow
/// unless a size is less than 2^-60 of the whole.
class AreaMeasure {
 public:
  explicit AreaMeasure(const Box& whole) {
    const Float4 e = half_extent(whole);
    const float largest = std::max({e[0], e[1], e[2], 0.0F});
    const int exponent = std::bit_cast<std::int32_t>(largest) >> 23;  // biased exponent
    if (largest > 0) scale_ = std::bit_cast<float>(std::clamp(253 - exponent, 1, 253) << 23);
  }

  /// Returns a quarter of half the surface area of a nonempty box plus a small multiple of its
  /// total edge length. The second term makes the builder prefer the shorter of two boxes of zero
  /// area.
  [[nodiscard]] float operator()(const Box& b) const {
    const Float4 e = half_extent(b) * splat(scale_);
    return measure(e[0], e[1], e[2]);
  }

  /// Returns the measures of three boxes in the first three lanes.
  [[nodiscard]] Float4 operator()(const std::array<Box, 3>& boxes) const {
    const Float4 a = half_extent(boxes[0]), b = half_extent(boxes[1]), c = half_extent(boxes[2]);
    const Float4 x{a[0], b[0], c[0], 0}, y{a[1], b[1], c[1], 0}, z{a[2], b[2], c[2], 0};
    return measure(x * splat(scale_), y * splat(scale_), z * splat(scale_));
  }

  /// Returns, in the same unit, the limit of the total area of the boxes around a triangle's pieces
  /// as the pieces become ever smaller.
  [[nodiscard]] float of_triangle(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const float half = 0.5F * scale_;  // as in half_extent()
    const Vec3 n = glm::abs(glm::cross((b - a) * half, (c - a) * half));
    return 0.5F * (n.x + n.y + n.z);
  }

 private:
  template <class T>
  [[nodiscard]] static T measure(T x, T y, T z) {
    return x * y + (x + y) * z + 0x1p-24F * (x + y + z);
  }

  float scale_ = 0;
};

}  // namespace microtrace::build
