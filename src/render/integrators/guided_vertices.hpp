#pragma once
#include "render/guiding/path_guide.hpp"
#include "render/integrators/path_state.hpp"
#include "render/kernels/kernel.hpp"

#include <array>

namespace microtrace {

/// Samples the next directions of a queue's vertices by a mixture of BSDF and PathGuide.
class GuidedVertices {
 public:
  struct Points {
    const LaneFloats (&p)[3];
    int count;
  };
  /// Calls ShadingKernels::scatter for points in a queue, with the guide.
  void scatter(const PathGuide& guide, const ShadingKernels& kernels, const WaveStep& step,
               ScatterSetup setup, const Points& points, ScatterLanes& lanes);

 private:
  /// Sets the guide's values of the lanes before ShadingKernels::scatter.
  void prepare(const PathGuide& guide, const ShadingKernels& kernels, const WaveStep& step,
               const Points& points, bool refract, ScatterLanes& lanes);
  /// Sets the next throughputs and pdfs, and plays Russian roulette, after ShadingKernels::scatter.
  void finish(const WaveStep& step, int count, ScatterLanes& lanes) const;

  std::array<const PathGuide::Cell*, kShadingLanes> cells_{};
  std::array<bool, kShadingLanes> is_smooth_{};
  alignas(64) LaneFloats u_[2]{}, chances_[2]{};
};

}  // namespace microtrace
