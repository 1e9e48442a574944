#pragma once
#include "render/guiding/path_guide.hpp"
#include "render/integrators/wavefront/path_state.hpp"
#include "render/lanes/shading_kernels.hpp"

namespace microtrace {

/// Samples the next directions of a queue's vertices by a mixture of BSDF and PathGuide.
class GuidedVertices {
 public:
  struct Points {
    const LaneFloats (&p)[3];
    int count;
  };
  /// Calls ShadingKernels::scatter for points in a queue, with the guide.
  void scatter(const PathGuide& guide, const ShadingKernels& kernels, ScatterSetup setup,
               const Points& points, ScatterLanes& lanes);

 private:
  /// Sets the guide's tables and other inputs of the lanes. Returns false if no lane is guided.
  bool find_tables(const PathGuide& guide, bool refract, const Points& points, ScatterLanes& lanes);

  GuideLanes<kShadingLanes> directions_{};
};

}  // namespace microtrace
