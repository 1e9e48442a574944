#include "base/split_mix.hpp"
#include "base/system/float_environment.hpp"
#include "scene/math/trigonometry.hpp"

#include <microtrace/dataset.hpp>

#include <cmath>
#include <numbers>

namespace microtrace {
namespace {

/// Returns the view whose direction has this azimuth in degrees and this height above the center of
/// a unit sphere, in [-1, 1].
DatasetView view_at(double azimuth, double height) {
  const double radius = std::sqrt((1 - height) * (1 + height));
  const double elevation = atan2_radians(height, radius) * (180 / std::numbers::pi);
  return {.camera = View{.azimuth = azimuth, .elevation = elevation}};
}

/// Returns the random number at position `index`, in [0, 1).
double random(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(split_mix(index + 1, seed << 32U) >> 11U) * 0x1p-53;
}

}  // namespace

std::vector<DatasetView> orbit_views(std::uint32_t count, double elevation) {
  const FloatEnvironment environment;
  std::vector<DatasetView> views;
  for (std::uint32_t i = 0; i < count; ++i)
    views.push_back({.camera = View{.azimuth = 360.0 * i / count, .elevation = elevation}});
  return views;
}

std::vector<DatasetView> hemisphere_views(std::uint32_t count) {
  const FloatEnvironment environment;
  std::vector<DatasetView> views;
  // The angle between consecutive points is 1 / (golden ratio)^2 of a revolution.
  constexpr double kTurn = 2 - std::numbers::phi;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double revolutions = i * kTurn;
    views.push_back(view_at(360 * (revolutions - std::floor(revolutions)), 1 - (i + 0.5) / count));
  }
  return views;
}

std::vector<DatasetView> random_views(std::uint32_t count, std::uint32_t seed) {
  const FloatEnvironment environment;
  std::vector<DatasetView> views;
  for (std::uint64_t i = 0; i < count; ++i)
    views.push_back(view_at(360 * random(seed, 2 * i), 2 * random(seed, 2 * i + 1) - 1));
  return views;
}

}  // namespace microtrace
