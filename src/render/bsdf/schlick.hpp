#pragma once
#include "simd/vector3.hpp"

namespace microtrace::bsdf {

/// Schlick's Fresnel approximation (C. Schlick, An inexpensive BRDF model for physically-based
/// rendering, 1994).
template <int N>
struct Schlick {
  Floats3<N> f0 = all3<N>(0.04F);  ///< reflectance at normal incidence
  Float<N> f90 = all<N>(1);        ///< reflectance at grazing angles

  bool operator==(const Schlick&) const requires(N == 1) = default;

  /// (1 - cosine)^5. The second part of the reflectance is (f90 - f0) times this factor.
  static Float<N> edge(const Float<N>& cosine) {
    const Float<N> x = 1 - cosine, square = x * x;
    return square * square * x;
  }
  [[nodiscard]] Floats3<N> operator()(const Float<N>& cosine) const {
    return f0 + (f90 - f0) * edge(cosine);
  }
};

}  // namespace microtrace::bsdf
