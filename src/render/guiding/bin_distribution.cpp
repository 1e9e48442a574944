#include "render/guiding/bin_distribution.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numbers>

namespace microtrace {
namespace {

constexpr std::uint32_t kNumbers = 1U << 24U;  // how many random numbers select a bin

}  // namespace

BinDistribution::BinDistribution(const SignedAxis& about, const Weights& weights) : about_(about) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  double below = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    below += weights[i];
    bounds_[i + 1] = std::max(static_cast<std::uint32_t>(below / sum * kNumbers), bounds_[i]);
  }
  // The last bin with a weight gets what rounding left.
  for (std::size_t i = weights.size(); i-- > 0;) {
    bounds_[i + 1] = kNumbers;
    if (weights[i] > 0) break;
  }
}

Vec3 BinDistribution::sample(const Vec2& u) const {
  const auto number = static_cast<std::uint32_t>(u.x * static_cast<float>(kNumbers));
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

float BinDistribution::pdf(const Vec3& d) const {
  const int bin = HemisphereBins(about_).bin(d);
  if (bin < 0) return 0;
  constexpr auto kScale =
      static_cast<float>(HemisphereBins::kCount / (2 * std::numbers::pi * kNumbers));
  const auto i = static_cast<std::size_t>(bin);
  return static_cast<float>(bounds_[i + 1] - bounds_[i]) * kScale;
}

}  // namespace microtrace
