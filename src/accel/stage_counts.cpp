#include "accel/stage_counts.hpp"

#include "accel/kernels/dispatch.hpp"
#include "exact/queries.hpp"

namespace microtrace {

StageCounts stage_counts() {
  StageCounts counts = fallback_stages;
  counts.edges = kRayKernels.best().edge_tests();
  counts.grid = exact::queries.grid;
  counts.dyadic = exact::queries.dyadic;
  return counts;
}

}  // namespace microtrace
