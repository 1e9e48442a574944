#pragma once
/// Local shading coordinates, in which z is the shading normal.

#include "simd/vector3.hpp"

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

template <int N>
struct Frame {
  using F = Float<N>;
  using V = Floats3<N>;

  V s, t, n;  ///< orthonormal axes in world space

  /// The frame whose z axis is a unit vector (T. Duff et al., Building an orthonormal basis,
  /// revisited, 2017).
  static Frame about(const V& n) {
    const F sign = with_sign_of<N>(all<N>(1), n.z);
    const F a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }

  [[nodiscard]] V to_local(const V& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  [[nodiscard]] V to_world(const V& v) const { return v.x * s + v.y * t + v.z * n; }
};

}  // namespace microtrace::bsdf
