#pragma once
#include "render/bsdf/ggx.hpp"

namespace microtrace::bsdf {

/// Schlick's term of the brightest channel: what lies below gets what that leaves over.
struct GreatestSchlick {
  float f0, f90;

  [[nodiscard]] float albedo(const Albedo& a) const {
    return f0 * (a.white - a.edge) + f90 * a.edge;
  }
};

}  // namespace microtrace::bsdf
