#include "render/guiding/environment_guide.hpp"

#include "render/guiding/cumulative.hpp"
#include "render/luminance.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numbers>

namespace microtrace {
namespace {

/// Surfaces that see more of the environment are sampled independently of visibility.
constexpr float kGreatestOpenness = 0.25F;
/// The probability of sampling by visibility. It is lower for maps, because small bright parts of a
/// map lie between the rays that found the visibility.
constexpr float kPartOfUniform = 0.875F, kPartOfMap = 0.5F;

}  // namespace

Vec3 EnvironmentGuide::Cell::sample(const Vec2& u) const {
  const auto number = static_cast<std::uint32_t>(u.x * static_cast<float>(kCumulativeNumbers));
  // The last bin that begins at or below the number. The binary search has no branches, of which
  // half would be mispredicted.
  std::size_t bin = 0;
  for (std::size_t step = std::bit_floor(bounds_.size()); step > 0; step /= 2) {
    const std::size_t next = std::min(bin + step, bounds_.size() - 1);
    bin = bounds_[next] <= number ? next : bin;
  }
  const std::uint32_t first = bounds_[bin], width = bounds_[bin + 1] - first;
  const float place = (static_cast<float>(number - first) + 0.5F) / static_cast<float>(width);
  return HemisphereBins(about_).direction(static_cast<int>(bin), {place, u.y});
}

float EnvironmentGuide::Cell::pdf(const Vec3& d) const {
  const int bin = HemisphereBins(about_).bin(d);
  if (bin < 0) return 0;
  constexpr auto kScale =
      static_cast<float>(HemisphereBins::kCount / (2 * std::numbers::pi * kCumulativeNumbers));
  const auto i = static_cast<std::size_t>(bin);
  return static_cast<float>(bounds_[i + 1] - bounds_[i]) * kScale;
}

std::unique_ptr<const EnvironmentGuide::Cell> EnvironmentGuide::fill(std::size_t index) const {
  const SkyVisibility::Cell& visible = visibility_.cell(index);
  auto cell = std::make_unique<Cell>();
  cell->about_ = visible.about;
  const HemisphereBins bins(visible.about);
  std::array<double, HemisphereBins::kCount> weights{};
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
    weights[i] = part * light * (cosine + kLeastCosine);
    sum += weights[i];
  }
  cell->openness_ = static_cast<float>(arriving / cosines);
  if (!(sum > 0) || cell->openness_ > kGreatestOpenness) return cell;
  cell->part_ = environment_.is_uniform() ? kPartOfUniform : kPartOfMap;
  accumulate_weights(weights, sum, cell->bounds_);
  return cell;
}

}  // namespace microtrace
