#pragma once
/// How often a tree's questions went past the float32 kernels.

#include <microtrace/export.hpp>

#include <cstdint>

namespace microtrace {

/// Numbers of questions, by the arithmetic that was asked; each stage is asked where the one before
/// it can't be sure. Of rays, "a question" is whether and where one ray hits one primitive, or
/// which of two hits is first; of origins, where a ray that leaves a surface begins. See
/// docs/exactness.md.
struct StageCounts {
  std::uint64_t edges = 0;             ///< a triangle's edges, by float64 within the kernels
  std::uint64_t filters = 0;           ///< float64 with error bounds
  std::uint64_t grid = 0;              ///< exact, by integers of fixed width
  std::uint64_t dyadic = 0;            ///< exact, by integers of any width
  std::uint64_t origins = 0;           ///< of rays that leave surfaces
  std::uint64_t searched_origins = 0;  ///< of these, not found by float64 alone
  std::uint64_t missing_origins = 0;   ///< of these, not found at all: paths end there

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

/// Of all questions that the calling thread has asked so far; the difference of two is what came
/// between.
[[nodiscard]] MICROTRACE_EXPORT StageCounts stage_counts();

}  // namespace microtrace
