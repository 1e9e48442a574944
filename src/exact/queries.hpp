#pragma once
/// Counts this thread's exact queries in the functions that decide them, so that none is missed.

#include <cstdint>

namespace microtrace::exact {

struct Queries {
  std::uint64_t grid = 0;    ///< queries decided by Grid: fixed-width integers
  std::uint64_t dyadic = 0;  ///< queries decided by Dyadic: arbitrary width
};

inline thread_local Queries queries;

}  // namespace microtrace::exact
