#include "scene/math/exponential.hpp"
#include "scene/tone_map.hpp"

#include <microtrace/film_view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
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
std::vector<bool> occupied(const Scene& scene, const Camera& camera, ImageSize whole,
                           const RenderOptions& options) {
  RenderOptions exact;
  exact.threads = options.threads;
  exact.crop = options.crop;
  exact.aovs = {Aov::id};
  const Film ids = render(scene, camera, whole, exact);
  const auto& instances = std::get<std::vector<std::uint32_t>>(ids.channels[0].values);
  std::vector<bool> result(instances.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = instances[i] != 0;
  return result;
}

}  // namespace

FilmView view_of(const Film& film, const Scene& scene, const Camera& camera,
                 const RenderOptions& options) {
  const Blackness is_black(film.display);
  const bool shows_all = scene.environment && scene.environment->is_background &&
                         options.integrator != nullptr && options.integrator->is_random();
  FilmView view;
  std::size_t lit = 0, black = 0;
  std::vector<std::size_t> doubtful;  // pixels that may show no surface
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    const std::span<const Vec3> colors = film.row(y);
    for (std::size_t x = 0; x < colors.size(); ++x) {
      if (film.has_alpha() && film.alpha_row(y)[x] == 0) continue;
      const bool may_be_empty = film.has_alpha() ? colors[x] == Vec3(0)  // may be a shadow
                                                 : !shows_all && colors[x] == scene.background;
      if (may_be_empty) {
        doubtful.push_back(std::size_t{y} * colors.size() + x);
      } else if (is_black(colors[x])) {
        ++black;
        view.brightest = std::max(view.brightest, greatest(colors[x]));
      } else {
        ++lit;
      }
    }
  }
  const bool are_black = film.has_alpha() || is_black(scene.background);
  if (lit + black == 0 || (are_black && is_most(black + doubtful.size(), lit))) {
    const std::vector<bool> is_there =
        doubtful.empty() ? std::vector<bool>() : occupied(scene, camera, film.whole, options);
    for (const std::size_t pixel : doubtful) (are_black ? black : lit) += is_there[pixel] ? 1 : 0;
  }
  view.is_empty = lit + black == 0;
  view.is_dark = is_most(black, lit);
  return view;
}

}  // namespace microtrace
