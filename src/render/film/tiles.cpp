#include "render/film/tiles.hpp"

#include "base/shared_range.hpp"
#include "base/system/start_threads.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace microtrace {
namespace {

using Clock = std::chrono::steady_clock;

/// The exception that stops a thread after another one has ended the work.
struct Ended {};

/// The time after which a thread reports its progress.
constexpr std::chrono::milliseconds kPatience{20};

/// The number of pixels after which a thread looks at the clock. Tiles that take long do so
/// themselves.
constexpr std::uint64_t kPixelsPerLook = 8 * kTilePixels;

std::size_t tiles_across(std::uint32_t pixels, std::uint32_t edge) {
  return (std::size_t{pixels} + edge - 1) / edge;
}

}  // namespace

std::size_t tile_columns(const PixelRect& window, std::uint32_t edge) {
  return tiles_across(window.size().width, edge);
}

std::size_t tile_count(const PixelRect& window, std::uint32_t edge) {
  return tile_columns(window, edge) * tiles_across(window.size().height, edge);
}

PixelRect tile_at(std::size_t index, const PixelRect& window, std::uint32_t edge) {
  const std::size_t columns = tile_columns(window, edge);
  const auto x0 = window.x0 + static_cast<std::uint32_t>(index % columns * edge);
  const auto y0 = window.y0 + static_cast<std::uint32_t>(index / columns * edge);
  return {.x0 = x0,
          .y0 = y0,
          .x1 = std::min(x0 + edge, window.x1),
          .y1 = std::min(y0 + edge, window.y1)};
}

void for_each_tile(const PixelRect& window, Threads& threads, const DrawTile& draw,
                   const std::function<bool(double)>& progress, std::uint32_t edge) {
  const std::uint64_t count = tile_count(window, edge);
  const std::uint64_t tiles_per_look =
      std::max<std::uint64_t>(kPixelsPerLook / (std::uint64_t{edge} * edge), 1);
  // A thread takes several consecutive tiles at a time: enough to avoid contention for the counter,
  // and few enough to balance the load.
  const std::uint64_t run =
      std::clamp<std::uint64_t>(count / (std::uint64_t{threads.wanted} * 32), 1, 64);
  SharedRange tiles(count, run);
  std::atomic<std::uint64_t> done{0};
  std::mutex report;

  const auto tell = [&] {
    if (tiles.is_ended()) throw Ended{};
    if (!progress) return;
    const std::scoped_lock lock(report);
    if (tiles.is_ended()) throw Ended{};
    if (progress(static_cast<double>(done) / static_cast<double>(count))) return;
    tiles.end();
    throw Error(ErrorKind::canceled, "", "the rendering was canceled");
  };
  const auto work = [&] {
    const StageCounts before = stage_counts();
    auto told = Clock::now();
    const std::function<void()> poll = [&] {
      if (Clock::now() - told < kPatience) return;
      tell();
      told = Clock::now();
    };
    tiles.take([&](std::uint64_t first, std::uint64_t last) {
      try {
        for (std::uint64_t index = first; index < last; ++index) {
          if (index % tiles_per_look == 0) poll();
          draw(tile_at(index, window, edge), poll);
          ++done;
        }
        tell();
      } catch (const Ended&) {
        // Another thread has ended the range, and keeps the reason.
      }
    });
    const std::scoped_lock lock(report);
    threads.stages += stage_counts() - before;
  };

  const auto wanted = static_cast<unsigned>(std::min<std::uint64_t>(threads.wanted, count));
  threads.missing = std::max(threads.missing, run_on_threads(wanted, threads.run, work));
  tiles.rethrow();
}

}  // namespace microtrace
