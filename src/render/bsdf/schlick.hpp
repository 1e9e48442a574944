#pragma once
#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// Reflectance by angle (C. Schlick, An inexpensive BRDF model for physically-based rendering,
/// 1994).
struct Schlick {
  Vec3 f0{0.04F};  ///< head on
  float f90 = 1;   ///< at grazing angles

  [[nodiscard]] Vec3 operator()(float cosine) const {
    const float x = 1 - cosine, square = x * x;
    return f0 + (Vec3(f90) - f0) * (square * square * x);
  }
};

inline float luminance(const Vec3& c) {
  return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
}

}  // namespace microtrace::bsdf
