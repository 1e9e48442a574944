#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "base/system/processors.hpp"
#include "render/aovs/aov_painter.hpp"
#include "render/film/clock.hpp"
#include "render/film/tiles.hpp"
#include "render/prepared/content.hpp"
#include "render/prepared/view.hpp"
#include "render/samples/draw_at_random.hpp"
#include "render/samples/lit_view.hpp"
#include "render/tile_painter.hpp"
#include "scene/validate/check_indices.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/denoise.hpp>
#include <microtrace/error.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

/// The number of 32-bit numbers per pixel of a film, including its channels.
std::uint64_t numbers_of_pixel(const RenderOptions& options) {
  constexpr std::uint64_t kMostOfAov = 4;
  return 4 + kMostOfAov * (options.aovs.size() + options.sampled_aovs.size());
}

[[noreturn]] void refuse_size(ImageSize size) {
  throw Error(ErrorKind::limit, "",
              "no memory for a picture of " + std::to_string(size.width) + " x " +
                  std::to_string(size.height) + " pixels; ask for a smaller one");
}

Film make_film(ImageSize whole, const PixelRect& window, Film::Alpha alpha, std::uint64_t numbers) {
  const ImageSize size = window.size();
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  if (pixels > PTRDIFF_MAX / (numbers * sizeof(float))) refuse_size(size);
  take_memory(pixels * numbers * sizeof(float), "the pixels of the picture");
  try {
    Film film(size, alpha);
    film.whole = whole;
    film.x0 = window.x0;
    film.y0 = window.y0;
    return film;
  } catch (const std::bad_alloc&) {
    refuse_size(size);
  }
}

[[noreturn]] void refuse_options(const std::string& message) {
  throw Error(ErrorKind::usage, "", message);
}

void check(const Shutter& shutter, const RenderOptions& options) {
  if (options.integrator == nullptr || !options.integrator->is_random())
    refuse_options("a shutter requires a Monte Carlo integrator");
  const ShutterTimes& times = shutter.times;
  const auto* paths = dynamic_cast<const PathIntegrator*>(options.integrator);
  if (paths != nullptr && paths->options().guiding)
    refuse_options("guiding can't be combined with a shutter");
  if (!std::isfinite(times.open) || !std::isfinite(times.close) || times.open > times.close)
    refuse_options("shutter.times.open and close must be finite, and open at most close");
  if (!std::has_single_bit(times.count) || times.count > kMaxSamples)
    refuse_options("shutter.times.count must be a power of two from 1 to " +
                   std::to_string(kMaxSamples) + ", not " + std::to_string(times.count));
  if (!shutter.moment) refuse_options("shutter.moment must be set");
  for (const SampledAov aov : options.sampled_aovs) {
    if (std::ranges::find(kDenoiseFeatures, aov) != kDenoiseFeatures.end())
      refuse_options(std::string(name_of(aov)) + " can't be combined with a shutter");
  }
}

void check(const Camera& camera, ImageSize size) {
  if (size.width == 0 || size.height == 0) refuse_options("the picture must have at least 1 pixel");
  if (const auto broken = validate(camera))
    throw Error(broken->kind, {.file = {},
                               .pointer = "/camera/" + broken->field,
                               .message = broken->message,
                               .excerpt = {}});
}

void check(const RenderOptions& options) {
  if (options.samples < 1 || options.samples > kMaxSamples) {
    refuse_options("samples per pixel must be 1 to " + std::to_string(kMaxSamples) + ", not " +
                   std::to_string(options.samples));
  }
  if (options.samples > 1 && options.integrator != nullptr && options.integrator->is_data())
    refuse_options("this integrator returns data, which can't be averaged: set samples to 1");
  const bool is_random = options.integrator != nullptr && options.integrator->is_random();
  if (options.passes) {
    if (!is_random) refuse_options("passes require a Monte Carlo integrator");
    const SampleRange range = options.passes->range.value_or(SampleRange{0, options.samples});
    if (options.passes->range && options.passes->target_error > 0)
      refuse_options("passes.range can't be combined with passes.target_error");
    if (!(options.passes->target_error >= 0))
      refuse_options("passes.target_error must not be negative");
    if (std::isnan(options.passes->time_limit))
      refuse_options("passes.time_limit must be a number");
    if (range.first >= range.last || range.last > options.samples)
      refuse_options("passes.range must be a nonempty range of the picture's samples, 0 to " +
                     std::to_string(options.samples));
  }
  if (options.shutter) check(*options.shutter, options);
  const auto require_once = [&](auto aovs) {
    std::ranges::sort(aovs);
    if (const auto twice = std::ranges::adjacent_find(aovs); twice != aovs.end())
      refuse_options("an output is requested twice: " + std::string(name_of(*twice)));
  };
  require_once(options.aovs);
  require_once(options.sampled_aovs);
  if (!options.sampled_aovs.empty() && !is_random) {
    refuse_options("this output requires a Monte Carlo integrator: " +
                   std::string(name_of(options.sampled_aovs.front())));
  }
}

/// The channels of exact quantities, which refer to the untranslated scene.
class ExactChannels {
 public:
  /// Adds the channels to the film. The window must outlive this object.
  ExactChannels(const SceneView& scene, const Camera& camera, std::span<const Aov> aovs,
                const PixelRect& window, Film& film)
      : buffers_(add_channels(aovs, film)) {
    if (buffers_.empty()) return;
    world_.emplace(scene.unlit_world(1));
    painter_.emplace(*world_, camera, buffers_, window);
  }
  ExactChannels(const ExactChannels&) = delete;
  ExactChannels& operator=(const ExactChannels&) = delete;

  /// Paints a part of the window that consists of whole tiles.
  void paint(const PixelRect& part) const {
    if (!painter_) return;
    for (std::size_t i = 0; i < tile_count(part); ++i) painter_->paint(tile_at(i, part));
  }

 private:
  std::vector<AovBuffer> buffers_;
  std::optional<World> world_;
  std::optional<AovPainter> painter_;
};

/// The side of the squares that each thread paints at a time. Large ones often have one color.
/// There must be enough of them to balance the load.
std::uint32_t part_edge(const PixelRect& window, unsigned threads) {
  constexpr std::uint32_t kLarge = 4 * kTileEdge;
  return tile_count(window, kLarge) >= std::size_t{16} * threads ? kLarge : kTileEdge;
}

/// Renders the film, which has the pixels of the window, by an integrator that is not random.
void draw_tiles(const SceneView& view, const Integrator& integrator, const RenderOptions& options,
                const PixelRect& window, Threads& threads, Film& film,
                const ExactChannels& channels) {
  World world = view.unlit_world(options.samples);
  world.seed = options.seed;
  const TilePainter colors(world, integrator, options, window, film);
  const auto draw = [&](const PixelRect& part, const auto& poll) {
    colors.paint(part, poll);
    channels.paint(part);
  };
  for_each_tile(window, threads, draw, options.progress, part_edge(window, threads.wanted));
  if (options.counts == nullptr) return;
  const ImageSize part = window.size();
  *options.counts = {.samples = std::uint64_t{part.width} * part.height * options.samples,
                     .samples_per_pixel = options.samples};
}

Film draw(const std::shared_ptr<const PreparedScene::Content>& content, const Camera& camera,
          ImageSize size, const RenderOptions& options) {
  check(camera, size);
  check(options);
  if (options.environment) check_environment(*options.environment, content->tables()->map().get());
  const PixelRect window = window_of(size, options.crop);
  Threads threads{.wanted = thread_count(options.threads), .run = options.run_threads};
  const auto start = Clock::now();
  const FlatIntegrator flat;
  const Integrator& integrator = options.integrator != nullptr ? *options.integrator : flat;

  const auto shown = content_for(content, camera, size);
  const SceneView exact(shown, camera, size);
  const SceneView view = integrator.is_random() ? near_origin(shown, camera, size) : exact;
  (void)view.content->bvh();
  if (!options.aovs.empty()) (void)exact.content->bvh();
  const auto built = Clock::now();

  std::optional<LitView> lit;
  if (integrator.is_random()) lit.emplace(view, options);
  Film film =
      make_film(size, window, options.transparent ? Film::Alpha::premultiplied : Film::Alpha::none,
                numbers_of_pixel(options));
  const ExactChannels channels(exact, camera, options.aovs, window, film);
  if (lit) {
    lit->train(options, size, threads);
    draw_at_random({.world = lit->world(),
                    .integrator = integrator,
                    .options = options,
                    .window = window,
                    .threads = threads,
                    .start = start},
                   film, [&](const PixelRect& tile) { channels.paint(tile); });
  } else {
    draw_tiles(view, integrator, options, window, threads, film, channels);
  }
  if (options.counts != nullptr) {
    options.counts->rays = integrator.ray_counts();
    options.counts->stages = threads.stages;
    options.counts->missing_threads = threads.missing;
  }
  film.display = integrator.display(film);
  if (options.times != nullptr)
    *options.times = {.build = seconds(start, built), .trace = seconds(built, Clock::now())};
  return film;
}

}  // namespace

Film render(const PreparedScene& scene, const Camera& camera, ImageSize size,
            const RenderOptions& options) {
  const FloatEnvironment environment;
  MemoryAccount memory(options.memory);
  const MemoryScope scope(memory);
  const std::shared_ptr<const PreparedScene::Content> content(std::shared_ptr<void>(),
                                                              &scene.content());
  return draw(content, camera, size, options);
}

Film render(const Scene& scene, const Camera& camera, ImageSize size,
            const RenderOptions& options) {
  const FloatEnvironment environment;
  MemoryAccount memory(options.memory);
  const MemoryScope scope(memory);
  check_indices(scene);
  const BvhOptions build{.threads = thread_count(options.threads)};
  const auto content = std::make_shared<const PreparedScene::Content>(
      borrowed(scene), build, std::make_shared<SharedTables>(), MemoryAccount(options.memory));
  return draw(content, camera, size, options);
}

}  // namespace microtrace
