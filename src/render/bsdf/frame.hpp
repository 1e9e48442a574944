#pragma once
/// Local shading coordinates: z is the shading normal.

#include <microtrace/math.hpp>

#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::bsdf {

inline Vec3 unit(const Vec3& v) {
  return v / std::sqrt(glm::dot(v, v));
}

struct Frame {
  Vec3 s, t, n;  ///< orthonormal, world space

  /// A frame around a unit vector (T. Duff et al., Building an orthonormal basis, revisited, 2017).
  static Frame about(const Vec3& n) {
    const float sign = std::copysign(1.0F, n.z);
    const float a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {.s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x},
            .t = {b, sign + n.y * n.y * a, -n.y},
            .n = n};
  }

  [[nodiscard]] Vec3 to_local(const Vec3& v) const {
    return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)};
  }
  [[nodiscard]] Vec3 to_world(const Vec3& v) const { return v.x * s + v.y * t + v.z * n; }
};

}  // namespace microtrace::bsdf
