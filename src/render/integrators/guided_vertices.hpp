#pragma once
#include "render/guiding/path_guide.hpp"
#include "render/integrators/path_state.hpp"
#include "render/kernels/kernel.hpp"

#include <array>

namespace microtrace {

/// Samples the next directions of a queue's vertices by a mixture of BSDF and PathGuide.
class GuidedVertices {
 public:
  /// Sets the guide's values of the lanes before ShadingKernels::scatter. `p` are the vertices.
  void prepare(const PathGuide& guide, const ShadingKernels& kernels, const WaveStep& step,
               int count, bool refracts, const LaneFloats (&p)[3], ScatterLanes& lanes);
  /// Completes the throughputs and pdfs after ShadingKernels::scatter.
  void finish(const WaveStep& step, int count, ScatterLanes& lanes) const;

 private:
  std::array<const PathGuide::Cell*, kShadingLanes> cells_{};
  std::array<bool, kShadingLanes> is_smooth_{};
  float brightness_ = 1;
  alignas(64) LaneFloats u_[2], chances_[2];
};

}  // namespace microtrace
