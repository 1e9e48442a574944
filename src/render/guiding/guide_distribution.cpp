#include "render/guiding/guide_distribution.hpp"

#include "render/guiding/blurred.hpp"
#include "render/guiding/guide_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace microtrace {
namespace {

constexpr int kEdge = GuideTable::kEdge, kParts = GuideTable::kParts;
constexpr std::size_t kBins = HemisphereBins::kCount;

/// A bin is divided if at least this fraction of the light arrives from it, in at least
/// kLeastLights directions.
constexpr std::uint64_t kFineFraction = 96;
constexpr std::uint32_t kLeastLights = 16;

constexpr BlurredGrid kBinGrid{.rows = HemisphereBins::kRows,
                               .columns = HemisphereBins::kColumns,
                               .is_round = true,
                               .center = 3};
constexpr BlurredGrid kPartGrid{.rows = kEdge, .columns = kEdge, .is_round = false, .center = 3};

std::size_t part_at(const Vec2& place) {
  const auto within = [](float x) {
    return std::min(static_cast<std::size_t>(x * kEdge), std::size_t{kEdge - 1});
  };
  return within(place.x) * kEdge + within(place.y);
}

/// The amounts of light from a bin.
struct BinLight {
  std::uint64_t sum = 0;
  std::uint32_t count = 0;
  std::array<double, kParts> parts{};
};

}  // namespace

GuideDistribution::GuideDistribution(const SignedAxis& about, std::span<const Weight> weights)
    : table_(std::make_unique<GuideTable>()) {
  GuideTable& table = *table_;
  table.axis = about.axis;
  table.sign = about.is_down ? -1.0F : 1.0F;
  double sum = 0, below = 0;
  for (const Weight& w : weights) sum += w.weight;
  std::uint32_t first = 0;
  for (const Weight& w : weights) {
    below += w.weight;
    const auto end = static_cast<std::uint32_t>(std::lround(below / sum * GuideTable::kSlots));
    const auto bin = static_cast<std::size_t>(w.bin), part = static_cast<std::size_t>(w.part);
    const auto count = static_cast<std::uint16_t>(end - first);
    if (part == GuideTable::kWhole) {
      table.counts[bin] = count;
    } else {
      if (part == 0) {
        table.counts[bin] = static_cast<std::uint16_t>(GuideTable::kFine + fine_.size());
        fine_.emplace_back();
      }
      fine_.back().slots[part] = count;
    }
    for (std::uint32_t slot = first; slot < end; ++slot) {
      table.slots[slot] = GuideSlot{.bin = static_cast<std::uint32_t>(bin),
                                    .part = static_cast<std::uint32_t>(part),
                                    .rank = slot - first,
                                    .count = count}
                              .packed();
    }
    first = end;
  }
  if (!fine_.empty()) table.fine = &fine_[0].slots;
}

Vec3 GuideDistribution::sample(const Vec2& u) const {
  GuideLanes<1> lanes{.tables = {table_.get()}, .u = {{u.x}, {u.y}}, .wi = {}, .pdf = {}};
  sample_guides<1>(lanes);
  return {lanes.wi[0][0], lanes.wi[1][0], lanes.wi[2][0]};
}

float GuideDistribution::pdf(const Vec3& d) const {
  GuideLanes<1> lanes{.tables = {table_.get()}, .u = {}, .wi = {{d.x}, {d.y}, {d.z}}, .pdf = {}};
  guide_pdfs<1>(lanes);
  return lanes.pdf[0];
}

GuideDistribution distribution_of(const SignedAxis& about, std::span<const ArrivingLight> light) {
  const HemisphereBins bins(about);
  std::array<BinLight, kBins> sums;
  std::uint64_t all = 0;
  for (const ArrivingLight& l : light) {
    const HemisphereBins::Place at = bins.place(l.d);
    BinLight& bin = sums[static_cast<std::size_t>(at.bin)];
    bin.sum += l.amount;
    ++bin.count;
    bin.parts[part_at(at.within)] += static_cast<double>(l.amount);
    all += l.amount;
  }
  std::array<double, kBins> plain{};
  for (std::size_t i = 0; i < kBins; ++i) plain[i] = static_cast<double>(sums[i].sum);
  const std::array<double, kBins> smooth = blurred(plain, kBinGrid);
  std::vector<GuideDistribution::Weight> weights;
  for (std::size_t i = 0; i < kBins; ++i) {
    const int bin = static_cast<int>(i);
    if (sums[i].sum == 0 || sums[i].sum < all / kFineFraction || sums[i].count < kLeastLights) {
      weights.push_back({.bin = bin, .part = GuideTable::kWhole, .weight = smooth[i]});
      continue;
    }
    const std::array<double, kParts> parts = blurred(sums[i].parts, kPartGrid);
    double sum = 0;
    for (const double part : parts) sum += part;
    for (int part = 0; part < kParts; ++part) {
      constexpr double kUniform = 0.125;
      const double share =
          (parts[static_cast<std::size_t>(part)] / sum + kUniform / kParts) / (1 + kUniform);
      weights.push_back({.bin = bin, .part = part, .weight = smooth[i] * share});
    }
  }
  return {about, weights};
}

}  // namespace microtrace
