#pragma once
/// Statistics on tests that float32 arithmetic could not decide.

#include <microtrace/export.hpp>

#include <cstdint>

namespace microtrace {

/// The number of tests by stage. A test decides whether and where a ray hits a primitive, or which
/// of two hits comes first. Each stage gets the tests that the previous stage could not decide. The
/// last three members count origins of rays that leave surfaces. See docs/exactness.md.
struct StageCounts {
  std::uint64_t edges = 0;             ///< tests of triangle edges by float64 in the kernels
  std::uint64_t filters = 0;           ///< tests by float64 with error bounds
  std::uint64_t grid = 0;              ///< exact tests by fixed-width integers
  std::uint64_t dyadic = 0;            ///< exact tests by arbitrary-width numbers
  std::uint64_t origins = 0;           ///< origins of rays that leave surfaces
  std::uint64_t searched_origins = 0;  ///< those of `origins` that float64 alone did not find
  std::uint64_t missing_origins = 0;   ///< those of `origins` that do not exist; paths end there

  StageCounts& operator+=(const StageCounts& other) {
    edges += other.edges;
    filters += other.filters;
    grid += other.grid;
    dyadic += other.dyadic;
    origins += other.origins;
    searched_origins += other.searched_origins;
    missing_origins += other.missing_origins;
    return *this;
  }
  friend StageCounts operator-(const StageCounts& a, const StageCounts& b) {
    return {.edges = a.edges - b.edges,
            .filters = a.filters - b.filters,
            .grid = a.grid - b.grid,
            .dyadic = a.dyadic - b.dyadic,
            .origins = a.origins - b.origins,
            .searched_origins = a.searched_origins - b.searched_origins,
            .missing_origins = a.missing_origins - b.missing_origins};
  }
};

/// Returns the counts of the calling thread so far. To count the tests of a section of code,
/// subtract the values before and after it.
[[nodiscard]] MICROTRACE_EXPORT StageCounts stage_counts();

}  // namespace microtrace
