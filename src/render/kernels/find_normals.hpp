#pragma once
/// Computes shading normals from normal textures.

#include "render/lanes/shading_kernels.hpp"
#include "render/shading/points/normals.hpp"

namespace microtrace {

template <int N>
void find_normals(const NormalLanes& points, NormalMapLanes& map) {
  using V = Floats3<N>;
  for (int i = 0; i < kShadingLanes; i += N) {
    const V ns = load3<N>(points.ns, i);
    const Float<N> handedness = load<N>(points.handedness + i) * load<N>(map.is_mapped + i);
    V mapped = ns;
    if (any(handedness != 0)) {
      const V weights = load3<N>(points.weights, i);
      const V sum = weights.x * load3<N>(points.tangents[0], i) +
                    weights.y * load3<N>(points.tangents[1], i) +
                    weights.z * load3<N>(points.tangents[2], i);
      mapped = mapped_normal<N>(ns, tangent_along<N>(sum, handedness, ns), load3<N>(map.texel, i),
                                load<N>(map.scale + i));
    }
    const Float<N> side = load<N>(points.side + i);
    const V wo = -unit<N>(load3<N>(points.d, i));
    store3<N>(map.normal, i, usable_normal<N>(side * mapped, side * load3<N>(points.n, i), wo));
  }
}

}  // namespace microtrace
