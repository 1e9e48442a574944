#pragma once
/// Counts this thread's queries to exact arithmetic, at the functions that answer them, so that
/// none is missed.

#include <cstdint>

namespace microtrace::exact {

struct Queries {
  std::uint64_t grid = 0;    ///< queries answered by Grid: fixed-width integers
  std::uint64_t dyadic = 0;  ///< queries answered by Dyadic: arbitrary width
};

inline thread_local Queries queries;

}  // namespace microtrace::exact
