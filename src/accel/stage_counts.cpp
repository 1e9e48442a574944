#include "accel/stage_counts.hpp"

#include "accel/kernels/dispatch.hpp"
#include "exact/questions.hpp"

namespace microtrace {

StageCounts stage_counts() {
  StageCounts counts = slow_stages;
  counts.edges = best_kernels().edge_tests();
  counts.grid = exact::questions.grid;
  counts.dyadic = exact::questions.dyadic;
  return counts;
}

}  // namespace microtrace
