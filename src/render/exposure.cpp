#include "base/system/float_environment.hpp"
#include "scene/math/exponential.hpp"

#include <microtrace/exposure.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

/// The bounds between which the exposure puts the percentile: 1/8 is 99 of 255 in sRGB, and values
/// above 1 are blown out without a tone map.
constexpr double kLeast = 0.125, kMost = 1;
constexpr double kPercentile = 0.95;
constexpr int kSteps = 10;                          ///< per stop
constexpr int kMostSteps = 64 * kSteps;             ///< the range of --exposure
constexpr std::uint32_t kSide = 48, kSamples = 16;  ///< of the small picture

/// Returns the size of a picture of the same shape whose longer side is at most kSide.
ImageSize small(ImageSize size) {
  const std::uint32_t longer = std::max({size.width, size.height, kSide});
  const auto scaled = [&](std::uint32_t side) {
    return std::max(1U, static_cast<std::uint32_t>(std::uint64_t{side} * kSide / longer));
  };
  return {.width = scaled(size.width), .height = scaled(size.height)};
}

/// Returns the percentile of the brightest channel over the lit surfaces that the film shows.
double percentile_of(Film& film) {
  std::vector<std::pair<float, float>> values;  // with weights
  double total = 0;
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    for (std::uint32_t x = 0; x < film.size().width; ++x) {
      const float alpha = film.alpha_at(x, y);
      const Vec3 color = film.at(x, y);
      const float brightest = std::max({color.x, color.y, color.z});
      if (alpha <= 0 || brightest <= 0) continue;  // black pixels may be shadows on the ground
      values.emplace_back(brightest / alpha, alpha);
      total += alpha;
    }
  }
  std::ranges::sort(values);
  double sum = 0;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (sum >= kPercentile * total) return value;
  }
  return 0;
}

/// Returns the exposure nearest to 0 that maps the value into [kLeast, kMost].
double exposure_for(double value) {
  const auto shown = [value](int steps) {
    return value * power_of_two(static_cast<double>(steps) / kSteps);
  };
  int steps = 0;
  while (steps > -kMostSteps && shown(steps) > kMost) --steps;
  while (steps < kMostSteps && shown(steps) < kLeast) ++steps;
  return static_cast<double>(steps) / kSteps;
}

}  // namespace

double automatic_exposure(const PreparedScene& scene, const Camera& camera, ImageSize size,
                          const RenderOptions& options) {
  const FloatEnvironment float_environment;
  const bool is_random = options.integrator != nullptr && options.integrator->is_random();
  // Only surfaces are measured.
  std::optional<Environment> environment =
      options.environment ? options.environment : scene.scene().environment;
  if (environment) environment->is_background = false;
  std::function<bool(double)> progress;
  if (options.progress) progress = [&](double) { return options.progress(0); };
  Film film = render(scene, camera, small(size),
                     {.threads = options.threads,
                      .run_threads = options.run_threads,
                      .progress = progress,
                      .integrator = options.integrator,
                      .samples = is_random ? kSamples : 1,
                      .memory = options.memory,
                      .environment = environment,
                      .background = options.background,
                      .transparent = true});
  const double value = film.display.srgb ? percentile_of(film) : 0;
  return value > 0 && std::isfinite(value) ? exposure_for(value) : 0;
}

}  // namespace microtrace
