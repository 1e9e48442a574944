#pragma once
/// Per-thread counters of the queries that float32 kernels pass on.

#include <microtrace/stage_counts.hpp>

namespace microtrace {

/// Excludes the counters that kernels and exact arithmetic keep themselves.
inline thread_local StageCounts fallback_stages;

}  // namespace microtrace
