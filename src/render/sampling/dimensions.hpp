#pragma once
/// Numbers of the pairs of random numbers of a sample. Changing the number of a pair changes every
/// path-traced picture. Pairs above 2^31 + 2^30 are unused and available for other purposes.

#include <cstdint>

namespace microtrace::sampling {

inline constexpr std::uint32_t kPixelPair = 0;                ///< position within the pixel
inline constexpr std::uint32_t kLensPair = 1U << 31U;         ///< position on the camera's lens
inline constexpr std::uint32_t kShutterPair = kLensPair + 1;  ///< time of the sample

/// Each path vertex has this many pairs, starting at kFirstVertexPair.
inline constexpr std::uint32_t kFirstVertexPair = 1, kVertexPairs = 5;
inline constexpr std::uint32_t kDirectionPair = 0;    ///< outgoing direction
inline constexpr std::uint32_t kLobePair = 1;         ///< choice of the lobe, and Russian roulette
inline constexpr std::uint32_t kLightPair = 2;        ///< position on a light
inline constexpr std::uint32_t kLightChoicePair = 3;  ///< selection of the light
/// Decides if the path passes through a surface, according to the surface's alpha. Each further
/// surface that the segment meets uses a pair kPassedPairs later.
inline constexpr std::uint32_t kCoveragePair = 4;
inline constexpr std::uint32_t kPassedPairs = 1U << 16U;
/// Distance and color channel of a flight through a scattering medium. Each further segment of a
/// path uses the next pair. The direction after scattering has the direction pair of a vertex.
inline constexpr std::uint32_t kFirstFlightPair = kShutterPair + 1;

}  // namespace microtrace::sampling
