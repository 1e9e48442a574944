#pragma once
#include "render/guiding/hemisphere_bins.hpp"

#include <microtrace/math.hpp>

#include <array>
#include <cstdint>

namespace microtrace {

/// A pdf of directions that is constant within each of HemisphereBins. The probabilities of bins
/// are multiples of 2^-24, so the returned pdf is exact.
class BinDistribution {
 public:
  using Weights = std::array<double, HemisphereBins::kCount>;

  BinDistribution() = default;
  /// The weights must not be negative, and their sum must be positive and finite.
  BinDistribution(const SignedAxis& about, const Weights& weights);

  /// Samples a unit direction for u in [0, 1)^2.
  [[nodiscard]] Vec3 sample(const Vec2& u) const;
  /// The pdf of sample(), per steradian.
  [[nodiscard]] float pdf(const Vec3& d) const;

 private:
  SignedAxis about_{};
  /// Cumulative probabilities of the bins, from 0 to 2^24.
  std::array<std::uint32_t, HemisphereBins::kCount + 1> bounds_{};
};

}  // namespace microtrace
