#pragma once
/// Tests axis-aligned rectangles and right triangles against N rays.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/volume_test.hpp"

namespace microtrace {
namespace {

/// N rays, and values with which rectangles are tested.
template <int N>
struct RectangleRays {
  using F = Float<N>;
  F o[3], d[3];
  F inverse[3];  ///< 1 / d
  F slack[3];    ///< the part of the error bounds that depends on the origin
  F begin;       ///< hits certainly before it are culled

  RectangleRays(const KernelStream& stream, int first) {
    for (int axis = 0; axis < 3; ++axis) {
      o[axis] = load<N>(stream.o[axis] + first);
      d[axis] = load<N>(stream.d[axis] + first);
      // Where 1 / d might overflow, the test fails to decide. Where d is 0, t is infinite, or NaN
      // in the rectangle's plane.
      const F size = magnitude(d[axis]);
      const auto is_tiny = (size < 0x1p-100F) & (size > 0);
      inverse[axis] = is_tiny ? all<N>(__builtin_nanf("")) : 1 / d[axis];
      slack[axis] = 16 * kUnit * magnitude(o[axis]);
    }
    const F t_begin = load<N>(stream.t_begin + first);
    begin = greater(F(t_begin * (1 - 8 * kUnit) - kTiny), F{});
  }
};

/// The point where a ray meets the plane is o + t d with t = (plane - o_i) / d_i, and (x, y) is its
/// vector from the middle of the rectangle. t has three roundings, whose relative error is below
/// 3.01 u, because all of them are of products and of one difference of stored numbers; its sign is
/// exact. With the roundings of t d, the middle, the difference from it and the sum, the error of x
/// is at most 4.01 u |t d| + u (|middle| + |o - middle| + |x|). As |t d| is at most |x| + |o -
/// middle|, this is at most 5.1 u |x| + 5.1 u |o| + 6.2 u |middle|. The bounds have 16 u instead.
/// Comparisons with NaN are false, which makes rays that the test can't decide possible hits.
template <int N, int kAxis>
class RectangleTest {
 public:
  using F = Float<N>;

  __attribute__((always_inline))
  RectangleTest(const FewTriangles::Rectangle& rectangle, const RectangleRays<N>& rays)
      : rectangle_(rectangle),
        rays_(rays),
        t_((rectangle.plane - rays.o[kAxis]) * rays.inverse[kAxis]),
        x_(t_ * rays.d[kX] + (rays.o[kX] - rectangle.middle[0])),
        y_(t_ * rays.d[kY] + (rays.o[kY] - rectangle.middle[1])) {}

  /// Returns the lanes that certainly don't hit the rectangle before t_limit.
  [[nodiscard]] __attribute__((always_inline)) Lanes misses(const F& t_limit) const {
    return less<N>(rectangle_.outer[0] + rays_.slack[kX], magnitude(x_)) |
           less<N>(rectangle_.outer[1] + rays_.slack[kY], magnitude(y_)) |
           less<N>(t_, rays_.begin) | less<N>(t_limit, t_ * (1 - 8 * kUnit));
  }
  /// Returns the lanes that certainly hit the rectangle.
  [[nodiscard]] __attribute__((always_inline)) Lanes within() const {
    return less<N>(magnitude(x_), rectangle_.inner[0] - rays_.slack[kX]) &
           less<N>(magnitude(y_), rectangle_.inner[1] - rays_.slack[kY]);
  }
  [[nodiscard]] Interval<F> t() const {
    const F radius = magnitude(t_) * (8 * kUnit) + kTiny;
    return {t_ - radius, t_ + radius};
  }
  /// Returns the lanes in which t() is valid.
  [[nodiscard]] Lanes with_t() const { return less_equal<N>(t_, t_); }

  /// The sides of the diagonal on which rays certainly pass.
  struct Sides {
    Lanes first, second;  ///< those of the triangle (a, a + e1, a + e2) and of the other one
  };
  [[nodiscard]] __attribute__((always_inline)) Sides sides() const {
    const float p = rectangle_.per_edge[0], q = rectangle_.per_edge[1];
    const F across = x_ * p + y_ * q;
    const F error = rays_.slack[kX] * __builtin_fabsf(p) +
                    (rays_.slack[kY] * __builtin_fabsf(q) + rectangle_.diagonal_error);
    return {.first = less<N>(across, -error), .second = less<N>(error, across)};
  }

 private:
  static constexpr int kX = (kAxis + 1) % 3, kY = (kAxis + 2) % 3;
  const FewTriangles::Rectangle& rectangle_;
  const RectangleRays<N>& rays_;
  F t_, x_, y_;
};

}  // namespace
}  // namespace microtrace
