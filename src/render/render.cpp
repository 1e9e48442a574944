#include "base/memory_account.hpp"
#include "float_environment.hpp"
#include "render/aov_painter.hpp"
#include "render/draw_at_random.hpp"
#include "render/lights/lighting.hpp"
#include "render/recentre.hpp"
#include "render/shading/shading.hpp"
#include "render/surfaces.hpp"
#include "render/tile_painter.hpp"
#include "render/tiles.hpp"
#include "scene/mesh_memory.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/error.hpp>
#include <microtrace/render.hpp>
#include <microtrace/segments.hpp>
#include <microtrace/threads.hpp>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <new>
#include <string>
#include <vector>

namespace microtrace {
namespace {

using Clock = std::chrono::steady_clock;

/// Where samples are random their number is open: textures are filtered for the part of a pixel
/// that one of so many stands for.
constexpr std::uint32_t kSamplesOfRandomTextures = 16;

double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// Numbers of 32 bits that a film has for each pixel, with the channels beside its colours.
std::uint64_t numbers_of_pixel(const RenderOptions& options) {
  constexpr std::uint64_t most_of_aov = 4;
  return 4 + most_of_aov * (options.aovs.size() + options.sampled_aovs.size());
}

Film make_film(ImageSize whole, const PixelRect& window, Film::Alpha alpha, std::uint64_t numbers) {
  const ImageSize size = window.size();
  take_memory(std::uint64_t{size.width} * size.height * numbers * sizeof(float),
              "the pixels of the picture");
  try {
    Film film(size, alpha);
    film.whole = whole;
    film.x0 = window.x0;
    film.y0 = window.y0;
    return film;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, "",
                "no memory for a picture of " + std::to_string(size.width) + " x " +
                    std::to_string(size.height) + " pixels; ask for a smaller one");
  }
}

void check(const RenderOptions& options) {
  const auto refuse = [](const std::string& message) {
    throw Error(ErrorKind::usage, "", message);
  };
  if (options.samples < 1 || options.samples > kMaxSamples) {
    refuse("samples per pixel must be 1 to " + std::to_string(kMaxSamples) + ", not " +
           std::to_string(options.samples));
  }
  if (options.samples > 1 && options.integrator != nullptr && options.integrator->is_data())
    refuse("this integrator's picture is of numbers that are never mixed: one sample per pixel");
  const bool is_random = options.integrator != nullptr && options.integrator->is_random();
  if (options.passes) {
    if (!is_random)
      refuse("this integrator's answers are not random: its picture is not made in passes");
    const SampleRange part = options.passes->part.value_or(SampleRange{0, options.samples});
    if (options.passes->part && options.passes->target_error > 0)
      refuse("where the error settles the number of samples none can be a part of them");
    if (part.first >= part.last || part.last > options.samples)
      refuse("the part must hold samples of the picture, 0 to " + std::to_string(options.samples));
  }
  const auto require_once = [&](auto aovs) {
    std::ranges::sort(aovs);
    if (const auto twice = std::ranges::adjacent_find(aovs); twice != aovs.end())
      refuse("asks for the channels of " + std::string(name_of(*twice)) + " twice");
  };
  require_once(options.aovs);
  require_once(options.sampled_aovs);
  if (!options.sampled_aovs.empty() && !is_random) {
    refuse("this integrator's answers are not random: there are no channels of " +
           std::string(name_of(options.sampled_aovs.front())));
  }
}

PixelRect window_of(ImageSize size, const std::optional<PixelRect>& crop) {
  if (!crop) return {.x0 = 0, .y0 = 0, .x1 = size.width, .y1 = size.height};
  if (crop->x0 < crop->x1 && crop->y0 < crop->y1 && crop->x1 <= size.width &&
      crop->y1 <= size.height)
    return *crop;
  throw Error(ErrorKind::usage, "",
              "the crop must hold pixels of the picture: 0 <= x0 < x1 <= " +
                  std::to_string(size.width) + ", 0 <= y0 < y1 <= " + std::to_string(size.height));
}

/// What is exact is that of the scene as it stands.
Film render_recentred(const PlacedScene& near, const Scene& scene, const Camera& camera,
                      ImageSize size, const RenderOptions& options) {
  RenderOptions own = options;
  own.aovs.clear();
  Film film = render(near.scene, near.camera, size, own);
  if (options.aovs.empty()) return film;
  RenderOptions exact;
  exact.threads = options.threads;
  exact.crop = options.crop;
  exact.aovs = options.aovs;
  exact.memory = options.memory;
  Film channels = render(scene, camera, size, exact);
  film.channels.insert(film.channels.begin(), std::move_iterator(channels.channels.begin()),
                       std::move_iterator(channels.channels.end()));
  return film;
}

}  // namespace

Film render(const Scene& scene, const Camera& camera, ImageSize size,
            const RenderOptions& options) {
  const FloatEnvironment environment;
  MemoryAccount memory(options.memory);
  const MemoryScope scope(memory);
  if (has_segments(scene)) {
    take_memory(memory_of(scene), "points and lines as triangles");
    Scene widened = scene;
    widen_segments(widened, camera, size);
    return render(widened, camera, size, options);
  }
  check(options);
  if (options.integrator != nullptr && options.integrator->is_random()) {
    if (const auto near = recentred(scene, camera))
      return render_recentred(*near, scene, camera, size, options);
  }
  const PixelRect window = window_of(size, options.crop);
  Threads threads{.wanted = options.threads != 0 ? options.threads : default_threads()};
  const auto start = Clock::now();
  const Bvh bvh(scene, {.threads = threads.wanted});
  const auto built = Clock::now();
  const RayGenerator rays(camera, size);
  const FlatIntegrator flat;
  const Integrator& integrator = options.integrator != nullptr ? *options.integrator : flat;
  const std::uint32_t samples = integrator.is_random() ? kSamplesOfRandomTextures : options.samples;
  TexturePyramids pyramids(scene);
  const Surfaces surfaces(scene, bvh.primitives(), rays, samples, pyramids);
  World world{.scene = scene,
              .bvh = bvh,
              .surfaces = surfaces,
              .camera = rays,
              .seed = options.seed,
              .samples = samples};
  std::optional<Shading> shading;
  std::optional<Lighting> lighting;
  if (integrator.is_random()) {
    world.shading = &shading.emplace(scene, bvh.primitives(), pyramids);
    world.lighting = &lighting.emplace(scene, *shading, options.cache);
  }
  Film film =
      make_film(size, window, options.transparent ? Film::Alpha::premultiplied : Film::Alpha::none,
                numbers_of_pixel(options));
  // What is exact has nothing to do with samples.
  const Surfaces exact_surfaces(surfaces, 1);
  const World exact_world{.scene = scene, .bvh = bvh, .surfaces = exact_surfaces, .camera = rays};
  const AovPainter channels(exact_world, options.aovs, window, film);
  const auto paint_channels = [&](const PixelRect& tile) {
    if (!options.aovs.empty()) channels.paint(tile);
  };
  if (integrator.is_random()) {
    draw_at_random({.world = world,
                    .integrator = integrator,
                    .options = options,
                    .window = window,
                    .threads = threads,
                    .start = start},
                   film, paint_channels);
  } else {
    const TilePainter colors(world, integrator, options, window, film);
    const auto draw = [&](const PixelRect& tile) {
      colors.paint(tile);
      paint_channels(tile);
    };
    for_each_tile(window, threads, draw, options.progress);
    if (options.counts != nullptr) {
      const ImageSize part = window.size();
      *options.counts = {.samples = std::uint64_t{part.width} * part.height * options.samples,
                         .samples_per_pixel = options.samples};
    }
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

}  // namespace microtrace
