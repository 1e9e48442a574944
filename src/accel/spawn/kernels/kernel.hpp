#pragma once
/// Types of the kernels that compute origins of rays that leave triangles, many at a time in
/// float64. They perform the first steps of spawn_among() as far as float64 is certain. This header
/// may contain only plain data, because kernels for several instruction sets include it.

#include <cstdint>

namespace microtrace {

inline constexpr int kSpawnLanes = 16;

/// The maximum number of float32 steps by which an origin is moved off a flat surface. More are
/// never needed: let w_k = spacing(p_k), and let i be the axis with the largest |n_k| w_k, along
/// which origins are moved. The rounded point is at most 1/2 sum |n_k| w_k <= 3/2 |n_i| w_i behind
/// the surface. A step gains |n_i| w_i, or half of that below a power of two.
inline constexpr int kFlatSteps = 4;

/// Returns an upper bound of the distance from p_k after this number of steps. The first step away
/// from 0 has length w_k; later steps may have twice that length.
constexpr double reach_of(int steps, double w_k) {
  return 2 * steps * w_k;
}

using SpawnFloats = float[kSpawnLanes];

/// The points where rays hit triangles.
struct alignas(64) HitPointLanes {
  SpawnFloats a[3], b[3], c[3];  ///< vertices
  SpawnFloats o[3], d[3], t_min, t_max;
  // ---- set by the kernel:
  SpawnFloats is_sure;  ///< 1 if the other results are certain, otherwise 0
  SpawnFloats p[3];     ///< rounded hit point
  SpawnFloats axis;     ///< the axis along which origins are moved, 0 to 2
  double n[3][kSpawnLanes], permanent[3][kSpawnLanes];  ///< the normal, as in CrossProduct
  double reach[3][kSpawnLanes];  ///< upper bound, per axis, of the distances of origins and of the
                                 ///< exact hit point from p
  SpawnFloats lo[3], hi[3];      ///< a box around p +- reach; empty unless is_sure
  SpawnFloats plane_axis;        ///< the axis to which the normal is parallel, or -1
  SpawnFloats plane_at;          ///< the triangle's coordinate on this axis
  /// The side from which the ray arrives, 1 for the front and -1 for the back, and the origin of
  /// rays that leave to this side; 0 if it is not certain.
  SpawnFloats side, origin[3];
};

/// The directions and origins of rays that leave the points of HitPointLanes, one ray per point.
struct alignas(64) OriginLanes {
  SpawnFloats direction[3];
  SpawnFloats origin[3];  ///< set by the kernel
};

struct SpawnKernels {
  void (*find_hit_points)(HitPointLanes& lanes);
  /// Returns the wanted lanes whose origins are certain, one bit for each.
  std::uint32_t (*find_origins)(const HitPointLanes& points, OriginLanes& lanes,
                                std::uint32_t wanted);
};

extern const SpawnKernels kPortableSpawn;
#if defined(__x86_64__)
extern const SpawnKernels kAvx2Spawn, kAvx512Spawn;
#endif

}  // namespace microtrace
