#pragma once
/// What the pairs of random numbers of a sample are for.

#include <cstdint>

namespace microtrace::sampling {

inline constexpr std::uint32_t kPixelPair = 0;  ///< the place within the pixel
/// Each vertex of a path has this many pairs of its own, from kFirstVertexPair on.
inline constexpr std::uint32_t kFirstVertexPair = 1, kVertexPairs = 4;

}  // namespace microtrace::sampling
