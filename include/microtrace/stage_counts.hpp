#pragma once
/// The number of queries of a tree that float32 couldn't decide.

#include <microtrace/export.hpp>

#include <cstdint>

namespace microtrace {

/// Numbers of queries by stage; a stage is queried if the previous one can't decide. For rays, a
/// query is whether and where one ray hits one primitive, or which of two hits is first; for
/// origins, the origin of a ray that leaves a surface. See docs/exactness.md.
struct StageCounts {
  std::uint64_t edges = 0;             ///< triangle edges, by float64 in the kernels
  std::uint64_t filters = 0;           ///< float64 with error bounds
  std::uint64_t grid = 0;              ///< exact, by fixed-width integers
  std::uint64_t dyadic = 0;            ///< exact, by arbitrary-width numbers
  std::uint64_t origins = 0;           ///< origins of rays that leave surfaces
  std::uint64_t searched_origins = 0;  ///< of these, not found by float64 alone
  std::uint64_t missing_origins = 0;   ///< of these, nonexistent: paths end there

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

/// All queries of the calling thread so far. To count those of a step, subtract two values.
[[nodiscard]] MICROTRACE_EXPORT StageCounts stage_counts();

}  // namespace microtrace
