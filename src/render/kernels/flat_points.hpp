#pragma once
/// Computes the intersection points of rays and flat triangles.

#include "render/lanes/flat_lanes.hpp"
#include "render/shading/points/find_points.hpp"
#include "simd/transpose.hpp"

namespace microtrace {

/// Loads the triangles of N lanes. Stores what doesn't depend on their rays.
template <int N>
void load_flat(const FlatTriangle* triangles, FlatHits& flat, HitLanes& hits, int i) {
  constexpr int kColumns = sizeof(FlatTriangle) / sizeof(float);
  std::uint32_t indices[N];
  __builtin_memcpy(indices, flat.rows + i, sizeof indices);
  Float<N> columns[kColumns];
  load_rows<N>(triangles->corners[0], indices, columns);
  const auto is_flat = reinterpreted<Int<N>>(columns[12]) != 0;
  const auto put = [&](const Float<N>& x, float* to) {
    store<N>(to + i, is_flat ? x : load<N>(to + i));
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 3; ++corner)
      put(columns[3 * corner + axis], hits.corners[corner][axis]);
    put(columns[9 + axis], hits.n[axis]);
    put(columns[9 + axis], hits.ns[axis]);
  }
  store<N>(flat.is_flat + i, is_flat ? all<N>(1) : Float<N>{});
  __builtin_memcpy(flat.surfaces + i, &columns[13], sizeof columns[13]);
  const auto kind = reinterpreted<Int<N>>(columns[14]);
  const auto lanes_with = [&](std::uint32_t bit) {
    return true_lanes<N>((kind & static_cast<std::int32_t>(bit)) != 0) << i;
  };
  flat.simple |= lanes_with(FlatTriangle::kSimple);
  flat.with_back |= lanes_with(FlatTriangle::kHasBack);
  flat.with_open_back |= lanes_with(FlatTriangle::kHasOpenBack);
}

/// Computes the points of N lanes.
template <int N>
void intersect_flat(const FlatHits& flat, HitLanes& hits, int i) {
  const PlanePoints<N> points(hits, i);
  const auto is_flat = widened<N>(flat.is_flat + i) != 0;
  const auto put = [&](const Double<N>& x, float* to) {
    narrowed<N>(is_flat ? x : widened<N>(to + i), to + i);
  };
  points.put_common(put, hits);
}

/// Computes the points, except for the lanes without flat triangles. Leaves out the weights of the
/// corners and texture coordinates.
template <int N>
void find_flat_points(const FlatTriangle* triangles, FlatHits& flat, HitLanes& hits) {
  flat.simple = flat.with_back = flat.with_open_back = 0;
  for (int i = 0; i < kShadingLanes; i += N) load_flat<N>(triangles, flat, hits, i);
  for (int i = 0; i < kShadingLanes; i += kDoubleLanes<N>)
    intersect_flat<kDoubleLanes<N>>(flat, hits, i);
}

/// Sets the surfaces of all lanes.
template <int N>
void load_surfaces(const FlatSurface* table, const std::uint32_t (&which)[kShadingLanes],
                   SurfaceLanes& to) {
  constexpr int kColumns = sizeof(FlatSurface) / sizeof(float);
  for (int i = 0; i < kShadingLanes; i += N) {
    std::uint32_t indices[N];
    __builtin_memcpy(indices, which + i, sizeof indices);
    Float<N> columns[kColumns];
    load_rows<N>(table->base_color, indices, columns);
    store3<N>(to.base_color, i, {columns[0], columns[1], columns[2]});
    store<N>(to.metallic + i, columns[3]);
    store<N>(to.roughness + i, columns[4]);
    store3<N>(to.f0, i, {columns[5], columns[6], columns[7]});
    store<N>(to.f90 + i, columns[8]);
  }
}

}  // namespace microtrace
