#pragma once
/// How often the stages behind float32 were asked by this thread, for benchmarks and tests.

#include "accel/kernels/kernel.hpp"

#include <cstdint>

namespace microtrace {

struct StageCounts {
  std::uint64_t edges = 0;    ///< a triangle's edges, by float64 within the kernels
  std::uint64_t filters = 0;  ///< primitives that kernels left to the float64 filters
  std::uint64_t exact = 0;    ///< roots computed by exact arithmetic
};

/// Counted where they happen; `edges` is kept by the kernels.
inline thread_local StageCounts slow_stages;

/// So far, by this thread.
[[nodiscard]] inline StageCounts stage_counts(const Kernels& kernels) {
  StageCounts counts = slow_stages;
  counts.edges = kernels.edge_tests();
  return counts;
}

}  // namespace microtrace
