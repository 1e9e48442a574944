#pragma once
/// Counts the exact queries of each thread. The functions that decide queries increment the
/// counters themselves, so that no query is missed.

#include <cstdint>

namespace microtrace::exact {

struct Queries {
  std::uint64_t grid = 0;    ///< queries of Grid, by fixed-width integers
  std::uint64_t dyadic = 0;  ///< queries of Dyadic, by arbitrary-width numbers
};

inline thread_local Queries queries;

}  // namespace microtrace::exact
