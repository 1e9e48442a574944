#pragma once
#include "render/guiding/hemisphere_bins.hpp"
#include "render/lanes/guide_lanes.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace microtrace {

/// A pdf of directions on a hemisphere, from which kernels sample.
class GuideDistribution {
 public:
  /// A probability for a bin of HemisphereBins or for a part of one.
  struct Weight {
    int bin;
    int part;  ///< GuideTable::kWhole for the whole bin
    double weight;
  };
  /// Samples directions in proportion to the weights, which are ordered by bin and part. Their sum
  /// must be positive and finite. A bin that is not whole has weights for all of its parts.
  GuideDistribution(const SignedAxis& about, std::span<const Weight> weights);

  [[nodiscard]] const GuideTable& table() const { return *table_; }

  /// Samples a unit direction for u in [0, 1)^2.
  [[nodiscard]] Vec3 sample(const Vec2& u) const;
  /// The pdf of sample(), per steradian.
  [[nodiscard]] float pdf(const Vec3& d) const;

  /// The bytes of memory beyond the size of the object.
  [[nodiscard]] std::size_t memory() const {
    return sizeof(GuideTable) + fine_.size() * sizeof(Parts);
  }

 private:
  struct Parts {
    GuideTable::Parts slots;
  };

  std::unique_ptr<GuideTable> table_;
  std::vector<Parts> fine_;
};

/// Replaces null tables by one of the others, because the kernels read the tables of all lanes.
/// Returns false if all are null.
template <int width>
[[nodiscard]] bool complete_tables(GuideLanes<width>& lanes) {
  const auto is_there = [](const GuideTable* table) { return table != nullptr; };
  const auto* const some = std::ranges::find_if(lanes.tables, is_there);
  if (some == std::ranges::end(lanes.tables)) return false;
  const GuideTable* const table = *some;
  std::ranges::replace(lanes.tables, nullptr, table);
  return true;
}

/// Light from one direction.
struct ArrivingLight {
  Vec3 d;  ///< must be in the hemisphere
  std::uint64_t amount;
};
/// A pdf in proportion to smoothed sums of light. Bins from which much of the light arrives are
/// divided. The sum of the amounts must be positive and below 2^63.
[[nodiscard]] GuideDistribution distribution_of(const SignedAxis& about,
                                                std::span<const ArrivingLight> light);

}  // namespace microtrace
