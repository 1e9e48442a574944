#pragma once
/// Types shared by the shading kernels of all instruction sets: input, output, and the table of
/// functions. Plain data only: code of headers that other files include must not be compiled for a
/// specific instruction set.
///
/// A kernel performs the same computation for up to kShadingLanes paths, with the same bits, as the
/// scalar function named beside it.

#include <cstdint>

namespace microtrace {

inline constexpr int kShadingLanes = 16;

/// One float per path.
using LaneFloats = float[kShadingLanes];

/// Hits of mesh triangles: SurfacePoint, see surface_point().
struct alignas(64) HitLanes {
  LaneFloats o[3], d[3], t;
  LaneFloats corners[3][3];  ///< [corner][axis]
  LaneFloats normals[3][3];  ///< of the vertices; zero if the mesh has none
  LaneFloats uv[3][2];       ///< of set 0; zero if the mesh has none
  // ---- set by the kernel:
  LaneFloats is_sure;  ///< 1 if the other results are valid; else 0
  LaneFloats p[3], n[3], ns[3], weights[3], first_uv[2];
  LaneFloats from_behind;  ///< 1 if the ray arrives from behind, else 0
  LaneFloats distance, uv_scale;
};

/// Input and output of Shading::frame().
struct alignas(64) NormalLanes {
  LaneFloats d[3];             ///< direction of the incoming ray
  LaneFloats n[3], ns[3];      ///< geometric and interpolated, of the front
  LaneFloats side;             ///< 1 in front, -1 behind
  LaneFloats texel[3], scale;  ///< of the normal texture
  LaneFloats tangents[3][3];   ///< of the vertices, [vertex][axis]
  LaneFloats weights[3];       ///< barycentric
  LaneFloats handedness;       ///< of the tangents; 0: no normal texture
  // ---- set by the kernel:
  LaneFloats frame_n[3];
};

/// Direct light and the next direction at surfaces of bsdf::Bsdf without film and transmission:
/// Wave::ask_light() and Wave::scatter().
struct alignas(64) ScatterLanes {
  LaneFloats d[3];  ///< direction of the incoming ray
  LaneFloats frame_n[3];
  LaneFloats outwards[3];  ///< geometric normal on the ray's side
  LaneFloats base_color[3], metallic, roughness, f0[3], f90;  ///< bsdf::Parameters
  LaneFloats throughput[3];
  LaneFloats light_wi[3], light[3], light_pdf;  ///< LightSample; light is 0 if there is none
  std::uint32_t key[kShadingLanes], index[kShadingLanes];  ///< of sampling::Sobol
  // ---- set by the kernel:
  LaneFloats shadow[3];  ///< contribution of the light if it is not occluded
  LaneFloats pdf;        ///< pdf of the next direction; 0 if there is none
  LaneFloats wi[3], next_throughput[3];
};

/// Parameters common to all paths of a ScatterLanes.
struct ScatterSetup {
  std::uint32_t direction_pair, lobe_pair;
  float most_survival;  ///< maximum survival probability; 1: no Russian roulette
  // GgxAlbedo's tables, in rows of `albedo_steps`, and their means.
  int albedo_steps;
  const float *albedo_f1, *albedo_schlick, *mean_albedo_f1, *mean_albedo_schlick;
};

struct ShadingKernels {
  const char* name;
  /// Computes sampling::Sobol(keys[i], indices[i]).pair(number) for kShadingLanes samples.
  void (*random_pairs)(const std::uint32_t* keys, const std::uint32_t* indices,
                       std::uint32_t number, float* x, float* y);
  void (*find_points)(HitLanes& lanes);
  void (*find_normals)(NormalLanes& lanes);
  void (*scatter)(const ScatterSetup& setup, ScatterLanes& lanes);
};

extern const ShadingKernels kPortableShading;
#if defined(__x86_64__)
extern const ShadingKernels kAvx2Shading, kAvx512Shading;
#endif

}  // namespace microtrace
