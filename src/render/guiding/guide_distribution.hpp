#pragma once
#include "render/guiding/hemisphere_bins.hpp"

#include <microtrace/math.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

/// A pdf of directions on a hemisphere: constant within each of HemisphereBins, or within each of
/// kParts^2 parts of the bins from which much of the light arrives.
class GuideDistribution {
 public:
  static constexpr int kParts = 4;  ///< parts of a fine bin along each side

  /// Light from one direction. The direction must be in the hemisphere.
  struct Light {
    Vec3 d;
    std::uint64_t amount;
  };
  /// The sum of the amounts must be positive and below 2^63.
  GuideDistribution(const SignedAxis& about, std::span<const Light> light);

  /// Samples a unit direction for u in [0, 1)^2.
  [[nodiscard]] Vec3 sample(const Vec2& u) const;
  /// The pdf of sample(), per steradian.
  [[nodiscard]] float pdf(const Vec3& d) const;

  /// The bytes of memory beyond the size of the object.
  [[nodiscard]] std::size_t memory() const { return fine_.size() * sizeof fine_[0]; }

 private:
  static constexpr std::size_t kBins = HemisphereBins::kCount;
  static constexpr std::uint16_t kNone = 0xffff;

  void refine(std::span<const Light> light, const std::array<std::uint64_t, kBins>& sums);

  SignedAxis about_;
  /// Cumulative probabilities of the bins, from 0 to 2^24.
  std::array<std::uint32_t, kBins + 1> bounds_{};
  /// The bin that contains each multiple of 2^16.
  std::array<std::uint16_t, 256> first_{};
  std::array<std::uint16_t, kBins> fine_of_{};  ///< index in fine_; kNone for coarse bins
  /// Cumulative probabilities of the parts of fine bins, from 0 to 2^24.
  std::vector<std::array<std::uint32_t, kParts * kParts + 1>> fine_;
};

}  // namespace microtrace
