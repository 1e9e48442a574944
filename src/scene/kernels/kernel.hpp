#pragma once
/// Input and output of the kernels for surfaces and camera rays. Contains only plain data, because
/// kernels must not share inline functions with other translation units.

#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>

#include <cstddef>
#include <cstdint>

namespace microtrace {

/// A mesh, or a single triangle.
struct MeshArrays {
  const Vec3* positions = nullptr;
  const std::uint32_t* corners = nullptr;  ///< vertex indices, three per triangle
  const Vec3* normals = nullptr;           ///< null if the mesh has none
  const Vec2* uv = nullptr;                ///< set 0; null if the mesh has none
};

inline constexpr std::size_t kSurfaceLanes = 64;

/// Surfaces at the hits of up to kSurfaceLanes rays: the members of SurfaceInteraction, each
/// rounded once.
struct alignas(64) SurfaceBatch {
  template <class T>
  using Values = T[kSurfaceLanes];

  /// The lanes with triangles, one bit each. Values in the other lanes are undefined.
  std::uint64_t triangles;
  Values<const MeshArrays*> mesh;        ///< set in lanes with triangles
  Values<const std::uint32_t*> corners;  ///< the triangle's three vertex indices; set as `mesh`
  Values<std::uint32_t> object, primitive;
  // The kernel sets the members below, in lanes with triangles.
  Values<double> p[3];
  Values<float> n[3], ns[3];  ///< normals of the front side
  Values<float> side;         ///< 1: the ray arrives at the front side; -1: at the back
  Values<float> barycentrics[3];
  Values<float> uv[2];  ///< 0 if the mesh has none
};

/// Selects the outputs of a kernel besides p, side and barycentrics.
struct SurfaceParts {
  bool n = false, ns = false, uv = false;
};

/// Rays of a perspective camera. Their directions are proportional to corner + x right + y down.
struct PerspectiveRays {
  DVec3 corner, right, down;
  Vec3 origin;
  float least_t_min;
  double near, far;  ///< depths
};

struct SceneKernels {
  const char* name;
  /// Computes the surfaces at the rays' hits in the lanes with triangles. Returns the lanes with
  /// valid results. Results are invalid for triangles that have no area or are seen nearly edge-on.
  std::uint64_t (*find_surfaces)(const Ray* rays, const SurfaceParts& parts, SurfaceBatch& batch);
  /// Sets rays[i] to the ray through the pixel coordinates (x[i], y[i]).
  void (*perspective_rays)(const PerspectiveRays& camera, const double* x, const double* y,
                           Ray* rays, std::size_t count);
  /// Computes the change of the directions d of a perspective camera from row to row, divided by
  /// their lengths. `down` is the change of a vector of depth 1. `count` must be a multiple of 8.
  void (*row_spreads)(const DVec3& forward, const DVec3& down, const float* const (&d)[3],
                      double* spreads, std::size_t count);
};

extern const SceneKernels kPortableScene;
#if defined(__x86_64__)
extern const SceneKernels kAvx2Scene, kAvx512Scene;
#endif

}  // namespace microtrace
