#pragma once
/// A picture cut into tiles, shared among threads.

#include <microtrace/film.hpp>
#include <microtrace/stage_counts.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace microtrace {

/// Small enough that its rays make one bundle and go the same way.
inline constexpr std::uint32_t kTileEdge = 8;
inline constexpr std::size_t kTilePixels = std::size_t{kTileEdge} * kTileEdge;

/// How many tiles the window has, and how many of them lie side by side.
[[nodiscard]] std::size_t tile_count(const PixelRect& window);
[[nodiscard]] std::size_t tile_columns(const PixelRect& window);

/// Tiles in their order: row by row from the upper left.
[[nodiscard]] PixelRect tile_at(std::size_t index, const PixelRect& window);

/// The number of a tile of the window.
[[nodiscard]] inline std::size_t tile_index(const PixelRect& tile, const PixelRect& window) {
  return std::size_t{(tile.y0 - window.y0) / kTileEdge} * tile_columns(window) +
         (tile.x0 - window.x0) / kTileEdge;
}

/// Threads that share the tiles, the caller's among them.
struct Threads {
  unsigned wanted = 1;  ///< at least 1
  std::function<void(unsigned, const std::function<void()>&)>
      run{};             ///< RenderOptions::run_threads
  unsigned missing = 0;  ///< the most of them that the system ever refused to start
  StageCounts stages{};  ///< of what they drew
};

/// Calls draw once for every tile of the window, on those threads; then progress with the fraction
/// done. The first exception that draw throws stops the work and is thrown here; so is Error
/// (canceled) if progress returns false.
void for_each_tile(const PixelRect& window, Threads& threads,
                   const std::function<void(const PixelRect&)>& draw,
                   const std::function<bool(double)>& progress);

}  // namespace microtrace
