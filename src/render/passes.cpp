#include "render/passes.hpp"

#include "render/tiles.hpp"

#include <algorithm>
#include <array>

namespace microtrace {
namespace {

/// 64 pixels with so many samples fill the batches of a random integrator. The first passes are
/// shorter: a picture comes soon, and a time limit that is short is kept.
constexpr std::uint32_t kSamplesPerPass = kRandomBatch / (kTileEdge * kTileEdge);

void add_tile(const RandomPainter& painter, const PixelRect& tile, const SampleRange& range,
              SampleSums& sums) {
  std::array<PixelSum, kTilePixels> added{};
  painter.add(tile, range, added);
  std::size_t pixel = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x) sums.at(x, y) += added[pixel++];
  }
}

}  // namespace

void run_passes(const RandomPainter& painter, const SampleRange& wanted, const Passes& passes,
                std::chrono::steady_clock::time_point start, unsigned threads,
                const std::function<void(double)>& progress, SampleSums& sums) {
  std::uint32_t to_do = 0, done = 0;
  for (const SampleRange& range : sums.missing(wanted)) to_do += range.size();
  while (done < to_do) {
    SampleRange range = sums.missing(wanted).front();
    range.last = std::min(range.last, range.first + std::clamp(done, 1U, kSamplesPerPass));
    const auto tell = [&](double share) { progress((done + share * range.size()) / to_do); };
    for_each_tile(
        sums.window, threads, [&](const PixelRect& tile) { add_tile(painter, tile, range, sums); },
        progress ? std::function<void(double)>(tell) : nullptr);
    sums.note(range);
    done += range.size();
    if (passes.after_each) passes.after_each(sums);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (spent.count() >= passes.time_limit) break;
  }
  if (progress && (done < to_do || to_do == 0)) progress(1);
}

}  // namespace microtrace
