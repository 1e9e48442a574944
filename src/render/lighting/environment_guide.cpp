#include "render/lighting/environment_guide.hpp"

#include "render/lights/environment/map_light.hpp"
#include "scene/math/luminance.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace microtrace {
namespace {

/// Surfaces that see more of the environment are sampled independently of visibility.
constexpr float kGreatestOpenness = 0.25F;
/// The probability of sampling by visibility. It is lower for maps, because small bright parts of a
/// map lie between the rays that found the visibility.
constexpr float kPartOfUniform = 0.875F, kPartOfMap = 0.5F;

}  // namespace

std::unique_ptr<const EnvironmentGuide::Distribution> EnvironmentGuide::fill(
    std::size_t index) const {
  const SkyVisibility::Cell& visible = visibility_.cell(index);
  Cell& cell = cells_[index];
  const HemisphereBins bins(visible.about);
  std::vector<GuideDistribution::Weight> weights;
  double sum = 0, cosines = 0, arriving = 0;
  for (int bin = 0; bin < HemisphereBins::kCount; ++bin) {
    const auto i = static_cast<std::size_t>(bin);
    const double part = visible.bins[i] / 255.0, cosine = double{HemisphereBins::cosine(bin)};
    cosines += cosine;
    arriving += part * cosine;
    if (part == 0) continue;
    double light = 0;
    for (const Vec2& place :
         {Vec2(0.25F, 0.25F), Vec2(0.75F, 0.25F), Vec2(0.25F, 0.75F), Vec2(0.75F, 0.75F)})
      light += double{luminance(environment_.radiance(bins.direction(bin, place)))};
    // The normals of the cell's surfaces deviate from the axis.
    constexpr double kLeastCosine = 0.25;
    const double weight = part * light * (cosine + kLeastCosine);
    weights.push_back({.bin = bin, .part = GuideTable::kWhole, .weight = weight});
    sum += weight;
  }
  // The fraction of a uniform environment's irradiance that arrives.
  const auto openness = static_cast<float>(arriving / cosines);
  // The brightest parts of a map may be visible even if little of it is.
  constexpr float kLeast = 0x1p-6F;
  if (environment_.is_uniform()) cell.share = std::max(openness, kLeast) / kLeastMapPart;
  if (!(sum > 0) || openness > kGreatestOpenness) return std::make_unique<Distribution>();
  auto distribution = std::make_unique<Distribution>(GuideDistribution(visible.about, weights));
  cell.part = environment_.is_uniform() ? kPartOfUniform : kPartOfMap;
  cell.directions = &(*distribution)->table();
  return distribution;
}

}  // namespace microtrace
