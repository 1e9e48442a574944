#include "render/samples/passes.hpp"

#include "base/memory_account.hpp"
#include "render/film/tile_errors.hpp"
#include "render/film/tiles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

/// A tile of 64 pixels with this many samples fills a batch of a Monte Carlo integrator. The first
/// passes are shorter, so that a first picture appears early and short time limits are met.
constexpr std::uint32_t kSamplesPerPass = kRandomBatch / kTilePixels;

void add_tile(const RandomPainter& painter, const PixelRect& tile, const SampleRange& range,
              SampleSums& sums) {
  std::array<PixelSum, kTilePixels> added{};
  painter.add(tile, range, added);
  std::size_t pixel = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x) sums.at(x, y) += added[pixel++];
  }
}

/// Moves the samples of a tile from `pass` to `sums`.
void move_tile(const PixelRect& tile, SampleSums& pass, SampleSums& sums) {
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x)
      sums.at(x, y) += std::exchange(pass.at(x, y), PixelSum{});
  }
}

/// Sums without samples for the same part of the picture.
SampleSums empty_like(const SampleSums& sums) {
  take_memory(sums.pixels.size() * sizeof(PixelSum), "the samples of one pass");
  return {sums.whole, sums.window, sums.background};
}

/// The tiles that need no more samples.
class Stops {
 public:
  Stops(const SampleSums& sums, double target, bool has_alpha)
      : target_(target), has_alpha_(has_alpha), stopped_(tile_count(sums.window)) {
    if (target <= 0) return;
    const std::uint32_t most = sums.count();
    for (std::size_t i = 0; i < stopped_.size(); ++i) {
      const PixelRect tile = tile_at(i, sums.window);
      stopped_[i] = sums.at(tile.x0, tile.y0).count < most;
    }
  }

  /// Estimates the error and stops tiles if a check is due.
  void update(const SampleSums& sums) {
    const std::uint32_t count = sums.count();
    if (target_ <= 0 || count < kFirstCheck || !std::has_single_bit(count) ||
        sums.ranges() != std::vector<SampleRange>{{.first = 0, .last = count}})
      return;
    const std::vector<bool> good = good_tiles(tile_errors(sums, has_alpha_), sums.window, target_);
    for (std::size_t i = 0; i < stopped_.size(); ++i) stopped_[i] = stopped_[i] || good[i];
  }

  /// The part of the range that precedes the next check.
  [[nodiscard]] SampleRange until_check(SampleRange range) const {
    const std::uint32_t next = std::max(kFirstCheck, std::bit_ceil(range.first + 1));
    if (target_ > 0) range.last = std::min(range.last, next);
    return range;
  }

  [[nodiscard]] bool at(std::size_t tile) const { return stopped_[tile]; }
  [[nodiscard]] bool all() const { return std::ranges::find(stopped_, false) == stopped_.end(); }

 private:
  static constexpr std::uint32_t kFirstCheck = 32;
  double target_;
  bool has_alpha_;
  std::vector<bool> stopped_;
};

}  // namespace

void run_passes(const RandomDrawing& drawing, Painters& painters, const SampleRange& wanted,
                const Passes& passes, SampleSums& sums) {
  Threads& threads = drawing.threads;
  const std::function<bool(double)>& progress = drawing.options.progress;
  std::uint32_t to_do = 0, done = 0;
  for (const SampleRange& range : sums.missing(wanted)) to_do += range.size();
  Stops stops(sums, passes.target_error, drawing.options.transparent);
  const auto is_up = [&] {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - drawing.start;
    return spent.count() >= passes.time_limit;
  };
  // The caller's sums receive a pass when it is complete, so that a canceled pass leaves no trace.
  SampleSums pass;
  if (passes.sums != nullptr && to_do > 0) pass = empty_like(sums);
  SampleSums& target = passes.sums != nullptr ? pass : sums;
  while (done < to_do) {
    stops.update(sums);
    if (stops.all() || (done > 0 && is_up())) break;
    SampleRange range = sums.missing(wanted).front();
    range.last = std::min(range.last, range.first + std::max(std::clamp(done, 1U, kSamplesPerPass),
                                                             painters.least_pass()));
    range = stops.until_check(range);
    for (std::uint32_t slice = 0; slice < painters.slices(); ++slice) {
      const RandomPainter& painter = painters.at(slice);
      const auto draw = [&](const PixelRect& tile, const auto& /*poll*/) {
        if (!stops.at(tile_index(tile, sums.window))) add_tile(painter, tile, range, target);
      };
      const auto tell = [&](double share) {
        return progress((done + (slice + share) / painters.slices() * range.size()) / to_do);
      };
      for_each_tile(sums.window, threads, draw,
                    progress ? std::function<bool(double)>(tell) : nullptr);
    }
    if (&target == &pass) {
      const auto move = [&](const PixelRect& tile, const auto& /*poll*/) {
        move_tile(tile, pass, sums);
      };
      for_each_tile(sums.window, threads, move, nullptr);
    }
    sums.note(range);
    done += range.size();
    if (passes.after_each) passes.after_each(sums);
  }
  if (progress && (done < to_do || to_do == 0)) (void)progress(1);
}

}  // namespace microtrace
