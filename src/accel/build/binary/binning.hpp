#pragma once
/// Chooses the plane that splits a set of references by the surface area heuristic. Candidate
/// planes are the boundaries of equally spaced bins of the centroids. After I. Wald, On fast
/// construction of SAH-based bounding volume hierarchies, 2007.

#include "accel/build/area.hpp"
#include "accel/build/references/reference.hpp"

#include <array>
#include <span>

namespace microtrace::build {

inline constexpr int kMaxBins = 32;

/// Maps a reference to its bin along each axis.
class BinMapping {
 public:
  BinMapping(const Box& centroids, int bins);

  [[nodiscard]] int bins() const { return bins_; }
  [[nodiscard]] Int4 operator()(const Reference& r) const {
    const Float4 slot = min((centroid(r.box) - origin_) * scale_, splat(last_));
    return __builtin_convertvector(slot, Int4);
  }
  /// True if all references are in the same bin along every axis.
  [[nodiscard]] bool is_degenerate() const {
    return scale_[0] == 0 && scale_[1] == 0 && scale_[2] == 0;
  }

 private:
  Float4 origin_, scale_{};
  float last_;
  int bins_;
};

/// A number of references and the sum of their weights.
struct Load {
  std::uint32_t count = 0, weight = 0;

  Load& operator+=(const Load& b) {
    count += b.count;
    weight += b.weight;
    return *this;
  }
};

/// Returns the number of blocks for a weight (see kTriangleWeight).
[[nodiscard]] inline std::uint32_t blocks(std::uint32_t weight) {
  return weight / kOtherWeight + (weight % kOtherWeight != 0 ? 1 : 0);
}

/// A split of a set: references in bins up to `last_bin` along `axis` go to the left part.
struct Split {
  int axis = -1, last_bin = 0;
  float cost = std::numeric_limits<float>::infinity();  ///< the sum of area times expected number
                                                        ///< of blocks over both parts
  Box left, right;
  Load left_load, right_load;

  [[nodiscard]] bool exists() const { return axis >= 0; }
};

/// The box and the load of each bin along each axis.
class Bins {
 public:
  void clear(int bins);
  void add(std::span<const Reference> references, const BinMapping& mapping);
  void add(const Bins& other, int bins);
  [[nodiscard]] Split best_split(int bins, const AreaMeasure& area) const;

 private:
  /// One bin along each axis, or the union of several: a lane of the loads for each axis.
  struct Bin {
    std::array<Box, 3> boxes;
    UInt4 counts{}, weights{};

    void include(const Bin& b);
    /// Returns the area times the expected number of blocks; infinity if there are no references.
    [[nodiscard]] Float4 costs(const AreaMeasure& area) const;
  };

  Bin bins_[kMaxBins];
};

}  // namespace microtrace::build
