#pragma once
/// What the shading kernels of every instruction set have in common: their input, their output,
/// their table. Plain data only: code of headers that others include too must not be compiled for
/// an instruction set.
///
/// A kernel does for up to kShadingLanes paths at once, and to the same bits, what the code named
/// beside it does for one.

#include <cstdint>

namespace microtrace {

inline constexpr int kShadingLanes = 16;

/// A number for each path.
using LaneFloats = float[kShadingLanes];

/// Rays that meet triangles of meshes: SurfacePoint, see surface_point().
struct alignas(64) HitLanes {
  LaneFloats o[3], d[3], t;
  LaneFloats corners[3][3];  ///< [corner][axis]
  LaneFloats normals[3][3];  ///< of the vertices; zero where the mesh lacks them
  LaneFloats uv[3][2];       ///< of set 0; zero where the mesh lacks it
  // ---- by the kernel:
  LaneFloats is_sure;  ///< 1 if the rest is known; else 0
  LaneFloats p[3], n[3], ns[3], weights[3], first_uv[2];
  LaneFloats from_behind;  ///< 1 where the ray comes from behind, else 0
  LaneFloats distance, uv_scale;
};

/// Shading normals: Shading::frame().
struct alignas(64) NormalLanes {
  LaneFloats d[3];             ///< of the ray that comes
  LaneFloats n[3], ns[3];      ///< geometric and interpolated, on the front
  LaneFloats side;             ///< 1 in front, -1 behind
  LaneFloats texel[3], scale;  ///< of the normal texture
  LaneFloats tangents[3][3];   ///< of the vertices, [vertex][axis]
  LaneFloats weights[3];       ///< of the vertices
  LaneFloats handedness;       ///< of the tangents; 0: no normal texture
  // ---- by the kernel:
  LaneFloats frame_n[3];
};

/// Direct light and the way on at surfaces of bsdf::Bsdf without film, transmission and light that
/// goes through: Wave::ask_light() and Wave::scatter().
struct alignas(64) ScatterLanes {
  LaneFloats d[3];  ///< of the ray that comes
  LaneFloats frame_n[3];
  LaneFloats outwards[3];  ///< geometric normal on the ray's side
  LaneFloats base_color[3], metallic, roughness, f0[3], f90;  ///< bsdf::Parameters
  LaneFloats throughput[3];
  LaneFloats light_wi[3], light[3], light_density;  ///< LightSample; light is 0 where there is none
  std::uint32_t key[kShadingLanes], index[kShadingLanes];  ///< sampling::Sobol's
  // ---- by the kernel:
  LaneFloats shadow[3];  ///< what the light adds if nothing is in its way
  LaneFloats density;    ///< of the way on; 0 where there is none
  LaneFloats wi[3], next_throughput[3];
};

/// What is common to all paths of a ScatterLanes.
struct ScatterSetup {
  std::uint32_t direction_pair, lobe_pair;
  float most_survival;  ///< 1: no path ends by chance
  // GgxAlbedo's tables, by rows of `albedo_steps`, and their means.
  int albedo_steps;
  const float *white_albedo, *edge_albedo, *mean_white_albedo, *mean_edge_albedo;
};

struct ShadingKernels {
  const char* name;
  /// sampling::Sobol(keys[i], indices[i]).pair(number), kShadingLanes of them.
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
