#pragma once
#include "render/bsdf/ggx.hpp"

namespace microtrace::bsdf {

/// Schlick's Fresnel term of the brightest channel: the base gets the energy that it leaves.
struct GreatestSchlick {
  float f0, f90;

  [[nodiscard]] float albedo(const Albedo& a) const {
    return f0 * (a.f1 - a.schlick) + f90 * a.schlick;
  }
};

}  // namespace microtrace::bsdf
