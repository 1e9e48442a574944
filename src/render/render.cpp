#include "float_environment.hpp"
#include "render/tiles.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/error.hpp>
#include <microtrace/render.hpp>
#include <microtrace/threads.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <span>

namespace microtrace {
namespace {

Film make_film(ImageSize size) {
  try {
    return Film(size);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, "",
                "no memory for a picture of " + std::to_string(size.width) + " x " +
                    std::to_string(size.height) + " pixels; ask for a smaller one");
  }
}

}  // namespace

Film render(const Scene& scene, const Camera& camera, ImageSize size,
            const RenderOptions& options) {
  const FloatEnvironment environment;  // new threads inherit it
  const unsigned threads = options.threads != 0 ? options.threads : default_threads();
  const Bvh bvh(scene, {.threads = threads});
  const RayGenerator ray_through(camera, size);
  // The open interval (epsilon, infinity): rays hold closed ones, so it begins at the next float32.
  const float t_min = std::nextafter(scene.epsilon, std::numeric_limits<float>::infinity());
  Film film = make_film(size);

  const auto color_of = [&scene](const Object& object) {
    return Vec3(material_of(scene, object).base_color);
  };

  const auto draw = [&](const Tile& tile) {
    std::array<Ray, kTilePixels> rays;
    std::array<std::optional<Hit>, kTilePixels> hits;
    std::size_t count = 0;
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
        Ray& ray = rays[count++] = ray_through(x + 0.5, y + 0.5);
        ray.t_min = std::max(ray.t_min, t_min);
      }
    }
    bvh.intersect(std::span(rays).first(count), std::span(hits).first(count));
    const std::optional<Hit>* hit = hits.data();
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x, ++hit) {
        film.at(x, y) = *hit ? color_of(bvh.primitives().object((*hit)->id)) : scene.background;
      }
    }
  };
  for_each_tile(size, threads, draw, options.progress);
  return film;
}

}  // namespace microtrace
