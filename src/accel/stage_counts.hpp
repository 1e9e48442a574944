#pragma once
/// Per-thread counters of tests that the float32 kernels could not decide.

#include <microtrace/stage_counts.hpp>

namespace microtrace {

/// The counts of this thread, except those that kernels and exact arithmetic keep themselves
/// (edges, grid, dyadic).
inline thread_local StageCounts fallback_stages;

}  // namespace microtrace
