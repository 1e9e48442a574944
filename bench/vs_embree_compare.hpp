#pragma once
/// Measures microtrace and Embree on one scene.

#include "vs_embree_scenes.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::bench {

struct CompareOptions {
  unsigned threads = 1;  ///< threads for building and for queries, in both programs
  unsigned runs = 7;     ///< alternating runs of each program, whose median is reported
  /// Size of the picture whose camera rays are traced.
  ImageSize size{.width = 1920, .height = 1080};
};

struct BuildRow {
  std::string scene;
  std::size_t triangles = 0;
  unsigned threads = 1;
  /// Build times; those of Embree are for high and for medium quality.
  double ms_microtrace = 0, ms_embree = 0, ms_embree_medium = 0;
  /// Memory of the tree without the mesh.
  double bytes_per_triangle_microtrace = 0, bytes_per_triangle_embree = 0;
};

struct RayRow {
  std::string scene{}, kind{};
  unsigned threads = 1;
  std::size_t rays = 0;
  double mrays_microtrace = 0, mrays_embree_fast = 0, mrays_embree_robust = 0;
  /// Embree's fastest mode: instruction set, build quality, rays per call, flag.
  std::string mode_fast, mode_robust;
  double disagreements_fast = 0;  ///< fraction of rays for which the programs disagree
  double disagreements_robust = 0;
  /// microtrace's queries per ray to the stages after float32 (see StageCounts). Not counted with
  /// several threads.
  double edges = 0, filters = 0, exact = 0;
};

struct SceneRows {
  BuildRow build;
  std::vector<RayRow> rays;  ///< primary, bounce, occlusion
};

/// Measures builds and queries. Throws std::runtime_error if Embree fails or denormal numbers are
/// flushed to zero.
[[nodiscard]] SceneRows compare(const BenchScene& scene, const CompareOptions& options);

}  // namespace microtrace::bench
