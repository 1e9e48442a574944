#pragma once
/// Types of the kernels that compute origins of rays that leave triangles, many at a time in
/// float64: the first steps of spawn_among(), where float64 is certain. Plain data only; see
/// simd/vectors.hpp for the reason.

#include <cstdint>

namespace microtrace {

inline constexpr int kSpawnLanes = 16;

/// The maximum number of float32 steps by which an origin is moved off a flat surface. More are
/// never needed: with w_k = spacing(p_k) the rounded point is at most 1/2 sum |n_k| w_k <= 3/2
/// |n_i| w_i behind the surface, where i is the chosen axis, and a step gains |n_i| w_i, or half of
/// that below a power of two.
inline constexpr int kFlatSteps = 4;

/// The maximum distance from p_k after such steps: a step away from 0 has length w_k, and all but
/// the first may have twice that length.
constexpr double reach_of(int steps, double w_k) {
  return 2 * steps * w_k;
}

using SpawnFloats = float[kSpawnLanes];

/// Points where rays hit triangles.
struct alignas(64) HitPointLanes {
  SpawnFloats a[3], b[3], c[3];  ///< vertices
  SpawnFloats o[3], d[3], t_min, t_max;
  // ---- set by the kernel:
  SpawnFloats is_sure;  ///< 1 if the other results are certain; else 0
  SpawnFloats p[3];     ///< rounded
  SpawnFloats axis;     ///< axis along which origins are moved, 0 to 2
  double n[3][kSpawnLanes], permanent[3][kSpawnLanes];  ///< CrossProduct
  double reach[3][kSpawnLanes];  ///< bound of the distance of origins and the exact point from p,
                                 ///< per axis
  SpawnFloats lo[3], hi[3];      ///< a box around p +- reach; empty if the results are not certain
  SpawnFloats plane_axis;        ///< the normal's axis if it is parallel to one; else -1
};

/// The directions of rays that leave these points, one for each.
struct alignas(64) OriginLanes {
  SpawnFloats direction[3];
  // ---- set by the kernel:
  SpawnFloats is_sure;
  SpawnFloats origin[3];
};

struct SpawnKernels {
  void (*find_hit_points)(HitPointLanes& lanes);
  void (*find_origins)(const HitPointLanes& points, OriginLanes& lanes);
};

extern const SpawnKernels kPortableSpawn;
#if defined(__x86_64__)
extern const SpawnKernels kAvx2Spawn, kAvx512Spawn;
#endif

}  // namespace microtrace
