#pragma once
/// Shading normals from normal textures, adjusted to reflect above the surface.

#include "render/kernels/kernel.hpp"
#include "render/kernels/vector3.hpp"

namespace microtrace {
namespace {

/// mapped_normal() for N lanes.
template <int N>
inline Vector3<Float<N>> mapped_normals(const NormalLanes& lanes, int i) {
  using F = Float<N>;
  const auto ns = load3<N>(lanes.ns, i), weights = load3<N>(lanes.weights, i);
  const auto sum = weights.x * load3<N>(lanes.tangents[0], i) +
                   weights.y * load3<N>(lanes.tangents[1], i) +
                   weights.z * load3<N>(lanes.tangents[2], i);
  const auto along = sum - dot(ns, sum) * ns;
  const F square = dot(along, along), handedness = load<N>(lanes.handedness + i);
  const auto t = along / square_root<N>(square);
  const auto b = handedness * cross(ns, t);
  const auto texel = load3<N>(lanes.texel, i);
  const F scale = load<N>(lanes.scale + i), one = all<N>(1);
  const Vector3<F> v{texel.x * 2 - one, texel.y * 2 - one, texel.z * 2 - one};
  const auto turned = (scale * v.x) * t + (scale * v.y) * b + v.z * ns;
  const auto is_turned = (square > 0) & (handedness != 0) & (dot(turned, turned) > 0);
  return select3(is_turned, unit<N>(turned), ns);
}

/// The lanes in which wo is above the horizon of n, and its mirror direction is above the geometric
/// surface.
template <int N>
inline Lanes reflecting_outwards(const Vector3<Float<N>>& n, const Vector3<Float<N>>& ng,
                                 const Vector3<Float<N>>& wo) {
  const Float<N> least = all<N>(0.01F), cosine = dot(n, wo);
  return less_equal<N>(least, cosine) &
         less_equal<N>(smaller_of(0.9F * dot(wo, ng), least), dot(2 * cosine * n - wo, ng));
}

/// usable_normal() for N lanes.
template <int N>
inline Vector3<Float<N>> usable_normals(const Vector3<Float<N>>& n, const Vector3<Float<N>>& ng,
                                        const Vector3<Float<N>>& wo) {
  const Lanes are_good = reflecting_outwards<N>(n, ng, wo);
  if (are_good == kAllLanes<N>) return n;
  Float<N> low{}, high = all<N>(1);
  for (int step = 0; step < 6; ++step) {
    const Float<N> middle = (low + high) * 0.5F;
    const Lanes reach = reflecting_outwards<N>(unit<N>(n + middle * (ng - n)), ng, wo);
    high = select<N>(reach, middle, high);
    low = select<N>(reach, low, middle);
  }
  const auto turned = unit<N>(n + high * (ng - n));
  return {select<N>(are_good, n.x, turned.x), select<N>(are_good, n.y, turned.y),
          select<N>(are_good, n.z, turned.z)};
}

template <int N>
void find_normals(NormalLanes& lanes) {
  for (int i = 0; i < kShadingLanes; i += N) {
    const auto side = load<N>(lanes.side + i);
    const auto wo = -unit<N>(load3<N>(lanes.d, i));
    const auto n = side * mapped_normals<N>(lanes, i), ng = side * load3<N>(lanes.n, i);
    store3<N>(lanes.frame_n, i, usable_normals<N>(n, ng, wo));
  }
}

}  // namespace
}  // namespace microtrace
