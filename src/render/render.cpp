#include "float_environment.hpp"
#include "render/surfaces.hpp"
#include "render/tile_painter.hpp"
#include "render/tiles.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/error.hpp>
#include <microtrace/render.hpp>
#include <microtrace/segments.hpp>
#include <microtrace/threads.hpp>

#include <new>
#include <string>

namespace microtrace {
namespace {

Film make_film(ImageSize size, Film::Alpha alpha) {
  try {
    return Film(size, alpha);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, "",
                "no memory for a picture of " + std::to_string(size.width) + " x " +
                    std::to_string(size.height) + " pixels; ask for a smaller one");
  }
}

void check(const RenderOptions& options) {
  if (options.samples >= 1 && options.samples <= kMaxSamples) return;
  throw Error(ErrorKind::usage, "",
              "samples per pixel must be 1 to " + std::to_string(kMaxSamples) + ", not " +
                  std::to_string(options.samples));
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

}  // namespace

Film render(const Scene& scene, const Camera& camera, ImageSize size,
            const RenderOptions& options) {
  const FloatEnvironment environment;  // new threads inherit it
  if (has_segments(scene)) {
    Scene widened = scene;
    widen_segments(widened, camera, size);
    return render(widened, camera, size, options);
  }
  check(options);
  const PixelRect window = window_of(size, options.crop);
  const unsigned threads = options.threads != 0 ? options.threads : default_threads();
  const Bvh bvh(scene, {.threads = threads});
  const Surfaces surfaces(scene, bvh.primitives());
  const World world{.scene = scene, .bvh = bvh, .surfaces = surfaces};
  const FlatIntegrator flat;
  const RayGenerator ray_through(camera, size);
  Film film = make_film(window.size(),
                        options.transparent ? Film::Alpha::premultiplied : Film::Alpha::none);
  film.whole = size;
  film.x0 = window.x0;
  film.y0 = window.y0;
  const TilePainter painter(world, options.integrator != nullptr ? *options.integrator : flat,
                            ray_through, options, window, film);
  for_each_tile(
      window, threads, [&](const PixelRect& tile) { painter.paint(tile); }, options.progress);
  return film;
}

}  // namespace microtrace
