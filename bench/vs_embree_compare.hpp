#pragma once
/// Both programs on one scene.

#include "vs_embree_scenes.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::bench {

struct CompareOptions {
  unsigned threads = 1;                           ///< of both programs, for building and asking
  unsigned runs = 7;                              ///< of each program, in turn; the median counts
  ImageSize size{.width = 1920, .height = 1080};  ///< of the picture the rays come from
};

struct BuildRow {
  std::string scene;
  std::size_t triangles = 0;
  unsigned threads = 1;
  double ms_microtrace = 0, ms_embree = 0, ms_embree_medium = 0;  ///< Embree: high, medium quality
  double bytes_per_triangle_microtrace = 0, bytes_per_triangle_embree = 0;  ///< without the mesh
};

struct RayRow {
  std::string scene{}, kind{};
  unsigned threads = 1;
  std::size_t rays = 0;
  double mrays_microtrace = 0, mrays_embree_fast = 0, mrays_embree_robust = 0;
  std::string mode_fast, mode_robust;  ///< Embree's best: instruction set, build quality, rays of a
                                       ///< call, flag
  double disagreements_fast = 0;       ///< share of rays that hit one thing here, another there
  double disagreements_robust = 0;
  /// Our questions to the stages behind float32, for each ray; see StageCounts. With
  /// several threads not known.
  double edges = 0, filters = 0, exact = 0;
};

struct SceneRows {
  BuildRow build;
  std::vector<RayRow> rays;  ///< primary, bounce, occlusion
};

/// Throws std::runtime_error if Embree fails, or denormal numbers are flushed.
[[nodiscard]] SceneRows compare(const BenchScene& scene, const CompareOptions& options);

}  // namespace microtrace::bench
