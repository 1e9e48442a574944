#pragma once
/// Divides a picture into tiles, and distributes the tiles to threads.

#include "base/system/start_threads.hpp"

#include <microtrace/film.hpp>
#include <microtrace/stage_counts.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace microtrace {

/// The side of a tile in pixels. The rays of a tile form one packet of coherent rays.
inline constexpr std::uint32_t kTileEdge = 8;
inline constexpr std::size_t kTilePixels = std::size_t{kTileEdge} * kTileEdge;

/// The number of tiles in the window, and in each row of tiles. `edge` is the side of the tiles.
[[nodiscard]] std::size_t tile_count(const PixelRect& window, std::uint32_t edge = kTileEdge);
[[nodiscard]] std::size_t tile_columns(const PixelRect& window, std::uint32_t edge = kTileEdge);

/// The tile with this index. Tiles are numbered row by row from the upper left.
[[nodiscard]] PixelRect tile_at(std::size_t index, const PixelRect& window,
                                std::uint32_t edge = kTileEdge);

/// The index of a tile of the window.
[[nodiscard]] inline std::size_t tile_index(const PixelRect& tile, const PixelRect& window) {
  return std::size_t{(tile.y0 - window.y0) / kTileEdge} * tile_columns(window) +
         (tile.x0 - window.x0) / kTileEdge;
}

/// The threads that share the tiles, including the calling thread.
struct Threads {
  unsigned wanted = 1;   ///< at least 1
  HostThreads run{};     ///< RenderOptions::run_threads
  unsigned missing = 0;  ///< maximum number of threads that the system refused to start
  StageCounts stages{};  ///< counts summed over the rendered tiles
};

/// Draws a tile. It should call `poll` every few milliseconds and must let its exceptions pass.
using DrawTile = std::function<void(const PixelRect& tile, const std::function<void()>& poll)>;

/// Calls `draw` once for every tile with sides of `edge` on `threads`, and `progress` with the
/// finished fraction after tiles and every few milliseconds. The first exception that `draw` throws
/// stops the work and is rethrown. If `progress` returns false, the work stops with Error
/// (canceled).
void for_each_tile(const PixelRect& window, Threads& threads, const DrawTile& draw,
                   const std::function<bool(double)>& progress, std::uint32_t edge = kTileEdge);

}  // namespace microtrace
