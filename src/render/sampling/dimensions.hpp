#pragma once
/// What the pairs of random numbers of a sample are for.

#include <cstdint>

namespace microtrace::sampling {

inline constexpr std::uint32_t kPixelPair = 0;  ///< the place within the pixel

/// Each vertex of a path has this many pairs of its own, from kFirstVertexPair on.
inline constexpr std::uint32_t kFirstVertexPair = 1, kVertexPairs = 5;
inline constexpr std::uint32_t kDirectionPair = 0;    ///< where the path goes on
inline constexpr std::uint32_t kLobePair = 1;         ///< by which lobe, and whether at all
inline constexpr std::uint32_t kLightPair = 2;        ///< where on a light
inline constexpr std::uint32_t kLightChoicePair = 3;  ///< on which
inline constexpr std::uint32_t kCoveragePair = 4;     ///< whether a surface lets the path through;
                                                      ///< the next one kLayerPairs further, so on
inline constexpr std::uint32_t kLayerPairs = 1U << 16U;

}  // namespace microtrace::sampling
