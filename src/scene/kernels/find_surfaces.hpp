#pragma once
/// Computes surfaces at hits of triangles.

#include "scene/kernels/kernel.hpp"
#include "scene/kernels/triangle.hpp"
#include "simd/transpose.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Converts the float get(i) of each lane i to float64.
template <int N, class Get>
inline Double<N> gathered_doubles(const Get& get) {
  Float<N> v{};
  for (int i = 0; i < N; ++i) set_lane(v, i, get(i));
  return to_double<N>(v);
}
/// Converts the vectors *get(i) of all lanes i to float64. Transposes four rows at a time, because
/// inserting single lanes is slow.
template <int N, class Get>
inline Doubles3<N> gathered_vectors(const Get& get) {
  if constexpr (N % 4 == 0) {
    Float<4> m[N / 4][4];
    for (int group = 0; group < N / 4; ++group) {
      for (int k = 0; k < 4; ++k) {
        const Vec3* const v = get(4 * group + k);
        m[group][k] = Float<4>{v->x, v->y, v->z, 0};
      }
      transpose<4>(m[group]);
    }
    const auto column = [&](int axis) {
      if constexpr (N == 4)
        return to_double<N>(m[0][axis]);
      else
        return to_double<N>(
            __builtin_shufflevector(m[0][axis], m[1][axis], 0, 1, 2, 3, 4, 5, 6, 7));
    };
    static_assert(N <= 8);
    return {column(0), column(1), column(2)};
  }
  return {gathered_doubles<N>([&](int i) { return get(i)->x; }),
          gathered_doubles<N>([&](int i) { return get(i)->y; }),
          gathered_doubles<N>([&](int i) { return get(i)->z; })};
}

template <class Array>
inline void store_narrowed(const auto& v, Array& to, int i) {
  constexpr int N = sizeof(v.x) / sizeof(double);
  narrowed<N>(v.x, to[0] + i);
  narrowed<N>(v.y, to[1] + i);
  narrowed<N>(v.z, to[2] + i);
}

/// Handles the N lanes that start at `first`. A lane without a triangle repeats the first
/// lane that has one.
template <int N>
inline Lanes find_surfaces_from(int first, const Ray* rays, const SurfaceParts& parts,
                                SurfaceBatch& batch) {
  using D = Double<N>;
  using V = Doubles3<N>;
  const auto lanes = static_cast<Lanes>(batch.triangles >> first) & kAllLanes<N>;
  if (lanes == 0) return 0;
  int from[N];                      // index of each lane's hit
  const std::uint32_t* corners[N];  // of each lane's triangle
  const MeshArrays* meshes[N];
  for (int i = 0; i < N; ++i) {
    from[i] = first + ((lanes >> i & 1U) != 0 ? i : __builtin_ctz(lanes));
    meshes[i] = batch.mesh[from[i]];
    corners[i] = batch.corners[from[i]];
  }
  const auto at_corners = [&](const auto& make) {
    return TriangleCorners<N>{make(0), make(1), make(2)};
  };
  const V o = gathered_vectors<N>([&](int i) { return &rays[from[i]].o; });
  const V d = gathered_vectors<N>([&](int i) { return &rays[from[i]].d; });
  const TriangleCorners<N> t = at_corners([&](int k) {
    return gathered_vectors<N>([&](int i) { return meshes[i]->positions + corners[i][k]; });
  });
  const auto w = barycentrics_of<N>(t, o, d);
  const V p = weighted(w.v, t.a, t.b, t.c), area = area_vector<N>(t);
  const auto n = direction_of<N>(area);
  __builtin_memcpy(batch.p[0] + first, &p.x, sizeof(D));
  __builtin_memcpy(batch.p[1] + first, &p.y, sizeof(D));
  __builtin_memcpy(batch.p[2] + first, &p.z, sizeof(D));
  if (parts.n) store_narrowed(n.v, batch.n, first);
  store_narrowed(w.v, batch.barycentrics, first);
  const D zero{}, one = zero + 1;
  narrowed<N>(dot(d, area) > 0 ? D(-one) : one, batch.side + first);
  const Lanes sure = less<N>(Float<N>{}, to_single<N>(w.exists & n.exists ? one : zero)) & lanes;
  if (parts.ns) {
    constexpr Vec3 kNone(0);
    const TriangleCorners<N> normals = at_corners([&](int k) {
      return gathered_vectors<N>([&](int i) {
        return meshes[i]->normals == nullptr ? &kNone : meshes[i]->normals + corners[i][k];
      });
    });
    const auto ns = direction_of<N>(weighted(w.v, normals.a, normals.b, normals.c));
    store_narrowed(select3(ns.exists, ns.v, n.v), batch.ns, first);
  }
  if (parts.uv) {
    const auto coordinate = [&](int axis) {
      const auto at = [&](int k) {
        return gathered_doubles<N>([&](int i) {
          if (meshes[i]->uv == nullptr) return 0.0F;
          const Vec2& uv = meshes[i]->uv[corners[i][k]];
          return axis == 0 ? uv.x : uv.y;
        });
      };
      return weighted(w.v, at(0), at(1), at(2));
    };
    narrowed<N>(coordinate(0), batch.uv[0] + first);
    narrowed<N>(coordinate(1), batch.uv[1] + first);
  }
  return sure;
}

template <int N>
std::uint64_t find_surfaces(const Ray* rays, const SurfaceParts& parts, SurfaceBatch& batch) {
  std::uint64_t sure = 0;
  for (int i = 0; i < static_cast<int>(kSurfaceLanes); i += N)
    sure |= std::uint64_t{find_surfaces_from<N>(i, rays, parts, batch)} << i;
  return sure;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
