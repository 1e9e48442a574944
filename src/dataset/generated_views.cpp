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

/// Returns a number in [0, 1): SplitMix64 (G. Steele, D. Lea and C. Flood, Fast splittable
/// pseudorandom number generators, 2014) at position `index`.
double random(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = (seed << 32U) + (index + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9U;
  z = (z ^ z >> 27U) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ z >> 31U) >> 11U) * 0x1p-53;
}

}  // namespace

std::vector<DatasetView> orbit_views(std::uint32_t count, double elevation) {
  std::vector<DatasetView> views;
  for (std::uint32_t i = 0; i < count; ++i)
    views.push_back({.camera = View{.azimuth = 360.0 * i / count, .elevation = elevation}});
  return views;
}

std::vector<DatasetView> hemisphere_views(std::uint32_t count) {
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
  std::vector<DatasetView> views;
  for (std::uint64_t i = 0; i < count; ++i)
    views.push_back(view_at(360 * random(seed, 2 * i), 2 * random(seed, 2 * i + 1) - 1));
  return views;
}

}  // namespace microtrace
