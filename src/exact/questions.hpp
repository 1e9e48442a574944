#pragma once
/// How often exact arithmetic was asked by this thread: counted where its answers begin, so that
/// none is left out.

#include <cstdint>

namespace microtrace::exact {

struct Questions {
  std::uint64_t grid = 0;    ///< Grid: integers of fixed width
  std::uint64_t dyadic = 0;  ///< Dyadic: of any width
};

inline thread_local Questions questions;

}  // namespace microtrace::exact
