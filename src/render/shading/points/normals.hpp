#pragma once
/// Computes shading normals, for N lanes.

#include "simd/vector3.hpp"

namespace microtrace {

template <int N>
struct Tangent {
  Floats3<N> t;         ///< unit length, perpendicular to the shading normal
  Float<N> handedness;  ///< 1 or -1 with bitangent = handedness (n x t); 0 if there is no tangent
};

/// Makes the tangent for the shading normal n from a weighted sum of vertex tangents.
template <int N>
Tangent<N> tangent_along(const Floats3<N>& sum, const Float<N>& handedness, const Floats3<N>& n) {
  const Floats3<N> along = sum - dot(n, sum) * n;
  const Float<N> square = dot(along, along);
  return {unit<N>(along), square > 0 ? handedness : Float<N>{}};
}

/// The normal for a texel of a normal texture. Returns n if there is no tangent.
template <int N>
Floats3<N> mapped_normal(const Floats3<N>& n, const Tangent<N>& tangent, const Floats3<N>& texel,
                         const Float<N>& scale) {
  const Floats3<N> b = tangent.handedness * cross(n, tangent.t);
  const Floats3<N> v{texel.x * 2 - 1, texel.y * 2 - 1, texel.z * 2 - 1};
  const Floats3<N> turned = (scale * v.x) * tangent.t + (scale * v.y) * b + v.z * n;
  const auto is_turned = (tangent.handedness != 0) & (dot(turned, turned) > 0);
  return select3(is_turned, unit<N>(turned), n);
}

/// True if wo is above the horizon of n, and the reflection of wo at n is above the surface with
/// the geometric normal ng.
template <int N>
auto reflects_outwards(const Floats3<N>& n, const Floats3<N>& ng, const Floats3<N>& wo) {
  const Float<N> least = all<N>(0.01F), cosine = dot(n, wo);
  return (cosine >= least) &
         (dot((2 * cosine) * n - wo, ng) >= smaller_of(Float<N>(0.9F * dot(wo, ng)), least));
}

/// An interpolated or mapped normal n may reflect wo to a direction below the surface with the
/// geometric normal ng. In this case, returns approximately the first normal between n and ng that
/// doesn't. All vectors have unit length.
template <int N>
Floats3<N> usable_normal(const Floats3<N>& n, const Floats3<N>& ng, const Floats3<N>& wo) {
  const auto is_good = reflects_outwards<N>(n, ng, wo);
  if (!any(negated(is_good))) return n;
  Float<N> low{}, high = all<N>(1);
  for (int i = 0; i < 6; ++i) {
    const Float<N> middle = (low + high) * 0.5F;
    const auto reach = reflects_outwards<N>(unit<N>(n + middle * (ng - n)), ng, wo);
    high = reach ? middle : high;
    low = reach ? low : middle;
  }
  return select3(is_good, n, unit<N>(n + high * (ng - n)));
}

}  // namespace microtrace
