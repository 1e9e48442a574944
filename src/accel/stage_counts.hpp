#pragma once
/// Where the stages behind float32 count how often this thread asked them.

#include <microtrace/stage_counts.hpp>

namespace microtrace {

/// But for what kernels and exact arithmetic count themselves.
inline thread_local StageCounts slow_stages;

}  // namespace microtrace
