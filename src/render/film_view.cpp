#include "base/runs.hpp"
#include "base/system/float_environment.hpp"
#include "scene/math/exponential.hpp"
#include "scene/tone_map.hpp"

#include <microtrace/film_view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <glm/common.hpp>

namespace microtrace {
namespace {

float greatest(const Vec3& color) {
  return std::max({color.x, color.y, color.z});
}

/// Tests whether 8-bit formats store a color's channels as 0 or 1.
class Blackness {
 public:
  explicit Blackness(const Display& display)
      : factor_(static_cast<float>(power_of_two(display.exposure))), map_(display.tone_map) {}

  [[nodiscard]] bool operator()(const Vec3& color) const {
    constexpr float kDarkest = 1.5F / 255 / 12.92F;  // the sRGB curve is linear there
    return greatest(tone_mapped(factor_ * color, map_)) < kDarkest;
  }

 private:
  float factor_;
  ToneMap map_;
};

bool is_most(std::size_t black, std::size_t lit) {
  return black > 3 * lit;
}

/// For each pixel, true if a surface is visible at the pixel's center.
std::vector<bool> occupied(const PreparedScene& prepared, const Camera& camera, ImageSize whole,
                           const RenderOptions& options) {
  RenderOptions exact;
  exact.threads = options.threads;
  exact.run_threads = options.run_threads;
  exact.memory = options.memory;
  exact.crop = options.crop;
  exact.aovs = {Aov::id};
  const Film ids = render(prepared, camera, whole, exact);
  const auto& instances = std::get<std::vector<std::uint32_t>>(ids.channels[0].values);
  std::vector<bool> result(instances.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = instances[i] != 0;
  return result;
}

/// Calls f(first, color, count) for runs of pixels of the same color, without transparent pixels.
template <class F>
void for_each_run_of_colors(const Film& film, F&& f) {
  std::size_t first = 0;
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    if (!film.has_alpha()) {
      for_each_run(film.row(y), [&](const Vec3& color, std::size_t count) {
        f(first, color, count);
        first += count;
      });
      continue;
    }
    for (std::size_t x = 0; const Vec3& color : film.row(y)) {
      if (film.alpha_row(y)[x++] != 0) f(first, color, std::size_t{1});
      ++first;
    }
  }
}

}  // namespace

FilmView view_of(const Film& film, const PreparedScene& prepared, const Camera& camera,
                 const RenderOptions& options) {
  const FloatEnvironment float_environment;
  const Scene& scene = prepared.scene();
  const std::optional<Environment>& environment =
      options.environment ? options.environment : scene.environment;
  const Vec3 background = options.background.value_or(scene.background);
  const Blackness is_black(film.display);
  const bool shows_all = environment && environment->is_background &&
                         options.integrator != nullptr && options.integrator->is_random();
  // Pixels may show no surface if they have this color. A black pixel with alpha may be a shadow.
  const std::optional<Vec3> color_of_nothing = film.has_alpha() ? std::optional(Vec3(0))
                                               : shows_all      ? std::nullopt
                                                                : std::optional(background);
  FilmView view;
  std::size_t lit = 0, black = 0, doubtful = 0;
  for_each_run_of_colors(film, [&](std::size_t, const Vec3& color, std::size_t count) {
    if (color_of_nothing == color) {
      doubtful += count;
    } else if (is_black(color)) {
      black += count;
      view.brightest = std::max(view.brightest, greatest(color));
    } else {
      lit += count;
    }
  });
  const bool are_black = film.has_alpha() || is_black(background);
  if (doubtful > 0 && (lit + black == 0 || (are_black && is_most(black + doubtful, lit)))) {
    const std::vector<bool> is_there = occupied(prepared, camera, film.whole, options);
    for_each_run_of_colors(film, [&](std::size_t first, const Vec3& color, std::size_t count) {
      if (color_of_nothing != color) return;
      for (std::size_t i = first; i < first + count; ++i)
        (are_black ? black : lit) += is_there[i] ? 1 : 0;
    });
  }
  view.is_empty = lit + black == 0;
  view.is_dark = is_most(black, lit);
  return view;
}

}  // namespace microtrace
