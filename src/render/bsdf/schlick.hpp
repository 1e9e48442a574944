#pragma once
#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// Schlick's Fresnel approximation (C. Schlick, An inexpensive BRDF model for physically-based
/// rendering, 1994).
struct Schlick {
  Vec3 f0{0.04F};  ///< at normal incidence
  float f90 = 1;   ///< at grazing angles

  bool operator==(const Schlick&) const = default;

  [[nodiscard]] Vec3 operator()(float cosine) const {
    const float x = 1 - cosine, square = x * x;
    return f0 + (Vec3(f90) - f0) * (square * square * x);
  }
};

}  // namespace microtrace::bsdf
