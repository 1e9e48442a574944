#pragma once
#include <chrono>

namespace microtrace {

/// The clock that measures RenderTimes.
using Clock = std::chrono::steady_clock;

inline double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace microtrace
