#pragma once
/// A picture cut into tiles, shared among threads.

#include <microtrace/camera.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace microtrace {

/// Small enough that its rays make one bundle and go the same way.
inline constexpr std::uint32_t kTileEdge = 8;
inline constexpr std::size_t kTilePixels = std::size_t{kTileEdge} * kTileEdge;

/// Pixels [x0, x1) x [y0, y1).
struct Tile {
  std::uint32_t x0, y0, x1, y1;
};

/// Calls draw once for every tile, on that many threads, the caller's among them; then progress
/// with the share done. The first exception that draw throws stops the work and is thrown here.
void for_each_tile(ImageSize size, unsigned threads, const std::function<void(const Tile&)>& draw,
                   const std::function<void(double)>& progress);

}  // namespace microtrace
