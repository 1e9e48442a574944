#include "render/guiding/guide_distribution.hpp"

#include "render/guiding/cumulative.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>

namespace microtrace {
namespace {

constexpr std::uint32_t kNumbers = kCumulativeNumbers;
constexpr auto kCoarsePdf =
    static_cast<float>(HemisphereBins::kCount / (2 * std::numbers::pi * kNumbers));
constexpr float kPartPdf = GuideDistribution::kParts * GuideDistribution::kParts / 0x1p24F;

/// A bin is divided if at least this fraction of the light arrives from it, in at least
/// kLeastLights directions.
constexpr std::uint64_t kFineFraction = 96;
constexpr std::uint32_t kLeastLights = 16;

/// Averages each bin with its neighbors.
template <std::size_t n>
std::array<double, n> blurred(const std::array<double, n>& values, int rows, int columns,
                              bool is_round) {
  std::array<double, n> result{};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      double sum = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        const int y = std::clamp(row + dy, 0, rows - 1);
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = is_round ? (column + dx + columns) % columns
                                 : std::clamp(column + dx, 0, columns - 1);
          const int weight = (3 - 2 * std::abs(dx)) * (3 - 2 * std::abs(dy));
          sum += weight * values[static_cast<std::size_t>(y * columns + x)];
        }
      }
      result[static_cast<std::size_t>(row * columns + column)] = sum;
    }
  }
  return result;
}

/// Sets the bounds for these weights.
template <std::size_t n>
void accumulate(const std::array<double, n>& weights, std::array<std::uint32_t, n + 1>& bounds) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  accumulate_weights(weights, sum, bounds);
}

std::size_t part_at(const Vec2& place) {
  constexpr auto kParts = GuideDistribution::kParts;
  const auto row = std::min(static_cast<int>(place.x * kParts), kParts - 1);
  const auto column = std::min(static_cast<int>(place.y * kParts), kParts - 1);
  return static_cast<std::size_t>(row * kParts + column);
}

}  // namespace

GuideDistribution::GuideDistribution(const SignedAxis& about, std::span<const Light> light)
    : about_(about) {
  const HemisphereBins bins(about_);
  std::array<std::uint64_t, kBins> sums{};
  for (const Light& l : light) sums[static_cast<std::size_t>(bins.bin(l.d))] += l.amount;
  std::array<double, kBins> weights{};
  for (std::size_t i = 0; i < kBins; ++i) weights[i] = static_cast<double>(sums[i]);
  accumulate(blurred(weights, HemisphereBins::kRows, HemisphereBins::kColumns, true), bounds_);
  std::uint16_t bin = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    while (bounds_[bin + 1U] <= i << 16U) ++bin;
    first_[i] = bin;
  }
  refine(light, sums);
}

void GuideDistribution::refine(std::span<const Light> light,
                               const std::array<std::uint64_t, kBins>& sums) {
  const HemisphereBins bins(about_);
  std::array<std::uint32_t, kBins> counts{};
  std::uint64_t all = 0;
  for (const Light& l : light) {
    all += l.amount;
    ++counts[static_cast<std::size_t>(bins.bin(l.d))];
  }
  fine_of_.fill(kNone);
  std::vector<std::array<double, kParts * kParts>> weights;
  for (std::size_t i = 0; i < kBins; ++i) {
    if (sums[i] < all / kFineFraction || counts[i] < kLeastLights) continue;
    fine_of_[i] = static_cast<std::uint16_t>(weights.size());
    weights.emplace_back();
  }
  for (const Light& l : light) {
    const HemisphereBins::Place at = bins.place(l.d);
    const std::uint16_t fine = fine_of_[static_cast<std::size_t>(at.bin)];
    if (fine != kNone) weights[fine][part_at(at.within)] += static_cast<double>(l.amount);
  }
  fine_.resize(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    std::array<double, kParts* kParts> smooth = blurred(weights[i], kParts, kParts, false);
    double sum = 0;
    for (const double weight : smooth) sum += weight;
    for (double& weight : smooth) weight += sum * (0.125 / (kParts * kParts));
    accumulate(smooth, fine_[i]);
  }
}

Vec3 GuideDistribution::sample(const Vec2& u) const {
  const auto number = static_cast<std::uint32_t>(u.x * static_cast<float>(kNumbers));
  std::size_t bin = first_[number >> 16U];
  while (bounds_[bin + 1] <= number) ++bin;
  const std::uint32_t first = bounds_[bin], width = bounds_[bin + 1] - first;
  const float along = std::min(
      (static_cast<float>(number - first) + 0.5F) / static_cast<float>(width), 0x1.fffffep-1F);
  Vec2 place(along, u.y);
  if (const std::uint16_t fine = fine_of_[bin]; fine != kNone) {
    const auto& parts = fine_[fine];
    const auto choice = static_cast<std::uint32_t>(along * static_cast<float>(kNumbers));
    std::size_t part = 0;
    while (parts[part + 1] <= choice) ++part;
    const float within = (static_cast<float>(choice - parts[part]) + 0.5F) /
                         static_cast<float>(parts[part + 1] - parts[part]);
    place = {(static_cast<float>(part / kParts) + within) / kParts,
             (static_cast<float>(part % kParts) + u.y) / kParts};
  }
  return HemisphereBins(about_).direction(static_cast<int>(bin), place);
}

float GuideDistribution::pdf(const Vec3& d) const {
  const HemisphereBins::Place at = HemisphereBins(about_).place(d);
  if (at.bin < 0) return 0;
  const auto bin = static_cast<std::size_t>(at.bin);
  const float pdf = static_cast<float>(bounds_[bin + 1] - bounds_[bin]) * kCoarsePdf;
  const std::uint16_t fine = fine_of_[bin];
  if (fine == kNone) return pdf;
  const std::size_t part = part_at(at.within);
  return pdf * (static_cast<float>(fine_[fine][part + 1] - fine_[fine][part]) * kPartPdf);
}

}  // namespace microtrace
