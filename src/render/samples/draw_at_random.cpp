#include "render/samples/draw_at_random.hpp"

#include "base/memory_account.hpp"
#include "render/film/film_pixel.hpp"
#include "render/film/tiles.hpp"
#include "render/samples/painters.hpp"
#include "render/samples/passes.hpp"
#include "render/samples/sampled_aov_painter.hpp"

#include <microtrace/error.hpp>

#include <array>
#include <cstddef>
#include <new>
#include <span>
#include <vector>

namespace microtrace {
namespace {

/// Initializes the sums if they are empty; otherwise checks that they belong to this picture.
void prepare(SampleSums& sums, const RandomDrawing& drawing, ImageSize whole,
             const Vec3& background) {
  if (sums.pixels.empty()) {
    const ImageSize size = drawing.window.size();
    take_memory(std::uint64_t{size.width} * size.height * sizeof(PixelSum),
                "the samples of pixels");
    try {
      sums = SampleSums(whole, drawing.window, background);
    } catch (const std::bad_alloc&) {
      throw Error(ErrorKind::limit, "",
                  "no memory for the samples of all pixels; ask for a smaller picture or a crop");
    }
  }
  if (sums.window != drawing.window || sums.background != background)
    throw Error(ErrorKind::usage, "", "passes.sums belong to another picture");
}

/// The number of samples of each pixel of a tile that take some milliseconds.
constexpr std::uint32_t kSamplesPerPoll = 64;

}  // namespace

void draw_at_random(const RandomDrawing& drawing, Film& film,
                    const std::function<void(const PixelRect&)>& beside) {
  const RenderOptions& options = drawing.options;
  const PixelRect& window = drawing.window;
  const Vec3 background =
      options.transparent ? Vec3(0) : options.background.value_or(drawing.world.scene.background);
  Painters painters(drawing, film.whole, background);
  const SampleRange all{.first = 0, .last = options.samples};
  std::uint32_t samples_per_pixel = options.samples;
  const SampledAovPainter channels(drawing.world, options, background, window, film);
  const auto set = [&](std::uint32_t x, std::uint32_t y, const PixelSum& pixel) {
    set_pixel(film, x - window.x0, y - window.y0, pixel.mean_color(), pixel.mean_alpha(),
              background);
    channels.set(std::size_t{y - window.y0} * film.size().width + (x - window.x0), pixel);
  };
  if (options.passes || options.shutter) {
    const Passes passes = options.passes.value_or(Passes{});
    SampleSums own;
    SampleSums& sums = passes.sums != nullptr ? *passes.sums : own;
    prepare(sums, drawing, film.whole, background);
    run_passes(drawing, painters, passes.range.value_or(all), passes, sums);
    samples_per_pixel = sums.count();
    // The channels of some of the samples are those of the whole picture.
    const bool is_part = passes.range.has_value();
    const std::vector<SampleRange> taken = is_part ? std::vector{all} : sums.ranges();
    const auto finish = [&](const PixelRect& tile, const auto& /*poll*/) {
      for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
        for (std::uint32_t x = tile.x0; x < tile.x1; ++x) set(x, y, sums.at(x, y));
      }
      channels.paint(tile, taken, is_part ? all.last : sums.at(tile.x0, tile.y0).count);
      beside(tile);
    };
    for_each_tile(window, drawing.threads, finish, nullptr);
  } else {
    const RandomPainter& painter = painters.at(0);
    const auto draw = [&](const PixelRect& tile, const auto& poll) {
      std::array<PixelSum, kTilePixels> sums{};
      for (SampleRange part{.first = 0, .last = 0}; part.last < all.last; poll()) {
        part = {.first = part.last, .last = std::min(part.last + kSamplesPerPoll, all.last)};
        painter.add(tile, part, sums);
      }
      std::size_t pixel = 0;
      for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
        for (std::uint32_t x = tile.x0; x < tile.x1; ++x) set(x, y, sums[pixel++]);
      }
      channels.paint(tile, std::span(&all, 1), all.last);
      beside(tile);
    };
    for_each_tile(window, drawing.threads, draw, options.progress);
  }
  if (options.counts != nullptr) {
    *options.counts = {.samples = painters.samples(),
                       .invalid_samples = painters.invalid_samples(),
                       .samples_per_pixel = samples_per_pixel};
  }
}

}  // namespace microtrace
