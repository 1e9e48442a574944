#pragma once
/// Measures both programs on one scene.

#include "vs_embree_scenes.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::bench {

struct CompareOptions {
  unsigned threads = 1;                           ///< for building and for queries, in both
                                                  ///< programs
  unsigned runs = 7;                              ///< alternating runs of each program; the median
                                                  ///< is reported
  ImageSize size{.width = 1920, .height = 1080};  ///< of the picture that generates the rays
};

struct BuildRow {
  std::string scene;
  std::size_t triangles = 0;
  unsigned threads = 1;
  double ms_microtrace = 0, ms_embree = 0, ms_embree_medium = 0;  ///< Embree at high and at medium
                                                                  ///< quality
  double bytes_per_triangle_microtrace = 0, bytes_per_triangle_embree = 0;  ///< excluding the mesh
};

struct RayRow {
  std::string scene{}, kind{};
  unsigned threads = 1;
  std::size_t rays = 0;
  double mrays_microtrace = 0, mrays_embree_fast = 0, mrays_embree_robust = 0;
  std::string mode_fast, mode_robust;  ///< Embree's best mode: instruction set, build quality, rays
                                       ///< per call, flag
  double disagreements_fast = 0;       ///< fraction of rays for which the programs disagree
  double disagreements_robust = 0;
  /// Queries per ray of microtrace to the stages after float32; see StageCounts. Unknown with
  /// several threads.
  double edges = 0, filters = 0, exact = 0;
};

struct SceneRows {
  BuildRow build;
  std::vector<RayRow> rays;  ///< primary, bounce, occlusion
};

/// Throws std::runtime_error if Embree fails, or denormal numbers are flushed.
[[nodiscard]] SceneRows compare(const BenchScene& scene, const CompareOptions& options);

}  // namespace microtrace::bench
