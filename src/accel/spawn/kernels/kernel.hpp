#pragma once
/// Rays that leave triangles, many at a time in float64: as spawn_among() begins, where float64 is
/// sure. Plain data only; see simd/vectors.hpp for why.

#include <cstdint>

namespace microtrace {

inline constexpr int kSpawnLanes = 16;

/// The representable numbers by which an origin is moved off a flat surface at most. It needs no
/// more: with w_k = spacing(p_k) the rounded point is at most 1/2 sum |n_k| w_k <= 3/2 |n_i| w_i
/// behind it, i being the axis chosen, and a step gains |n_i| w_i, or half of that below a power of
/// two.
inline constexpr int kFlatSteps = 4;

/// How far from p_k such steps may lead: a step away from 0 spans w_k, and all but the first maybe
/// twice that.
constexpr double reach_of(int steps, double w_k) {
  return 2 * steps * w_k;
}

using SpawnFloats = float[kSpawnLanes];

/// Points where rays hit triangles.
struct alignas(64) DepartureLanes {
  SpawnFloats a[3], b[3], c[3];  ///< corners
  SpawnFloats o[3], d[3], t_min, t_max;
  // ---- by the kernel:
  SpawnFloats is_sure;                                  ///< 1 where the rest is known; else 0
  SpawnFloats p[3];                                     ///< rounded
  SpawnFloats axis;                                     ///< along which origins are moved, 0 to 2
  double n[3][kSpawnLanes], permanent[3][kSpawnLanes];  ///< CrossProduct
  double reach[3][kSpawnLanes];  ///< origins and the exact point lie so near to p, axis by axis
};

/// Directions in which rays leave such points.
struct alignas(64) OriginLanes {
  SpawnFloats a[3], p[3], axis;  ///< as in DepartureLanes, the next too
  double n[3][kSpawnLanes], permanent[3][kSpawnLanes];
  SpawnFloats direction[3];
  // ---- by the kernel:
  SpawnFloats is_sure;
  SpawnFloats origin[3];
};

struct SpawnKernels {
  void (*find_departures)(DepartureLanes& lanes);
  void (*find_origins)(OriginLanes& lanes);
};

extern const SpawnKernels kPortableSpawn;
#if defined(__x86_64__)
extern const SpawnKernels kAvx2Spawn, kAvx512Spawn;
#endif

}  // namespace microtrace
