#include "accel/build/binary/binning.hpp"

namespace microtrace::build {
namespace {

// The expected number of blocks of sets of these weights that will be split further. It exceeds
// weight / 16, because splits often leave blocks partly filled.
Float4 expected_blocks(UInt4 weights) {
  static_assert(kOtherWeight == 16);
  const Float4 full = __builtin_convertvector(std::bit_cast<Int4>(weights >> 4), Float4),
               rest = __builtin_convertvector(std::bit_cast<Int4>(weights & 15), Float4);
  return full + (rest > 0 ? splat(1) : splat(0)) + 0.05F * (16.0F * full + rest);
}

}  // namespace

BinMapping::BinMapping(const Box& centroids, int bins)
    : origin_(centroids.lo), last_(static_cast<float>(bins - 1)), bins_(bins) {
  for (int k = 0; k < 3; ++k) {
    const float extent = centroids.hi[k] - centroids.lo[k];
    // For smaller extents, the reciprocal would overflow.
    if (extent > 0x1p-120F) scale_[k] = static_cast<float>(bins) * 0.9999F / extent;
  }
}

void Bins::clear(int bins) {
  std::fill_n(bins_, bins, Bin());
}

void Bins::add(std::span<const Reference> references, const BinMapping& mapping) {
  for (const Reference& r : references) {
    prefetch_after(r);
    const Int4 places = mapping(r);
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = bins_[places[axis]];
      bin.boxes[static_cast<std::size_t>(axis)].include(r.box);
      bin.counts[axis] += 1;
      bin.weights[axis] += r.weight();
    }
  }
}

void Bins::add(const Bins& other, int bins) {
  for (int i = 0; i < bins; ++i) bins_[i].include(other.bins_[i]);
}

void Bins::Bin::include(const Bin& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) boxes[axis].include(b.boxes[axis]);
  counts += b.counts;
  weights += b.weights;
}

Float4 Bins::Bin::costs(const AreaMeasure& area) const {
  const Float4 infinite = splat(std::numeric_limits<float>::infinity());
  return counts == 0 ? infinite : area(boxes) * expected_blocks(weights);
}

Split Bins::best_split(int bins, const AreaMeasure& area) const {
  Float4 right_costs[kMaxBins];  // of bins i and above
  Bin right;
  for (int i = bins - 1; i > 0; --i) {
    right.include(bins_[i]);
    right_costs[i] = right.costs(area);
  }
  Float4 least = splat(std::numeric_limits<float>::infinity());  // along each axis
  Int4 last_bins{};
  Bin left;
  for (int i = 0; i + 1 < bins; ++i) {
    left.include(bins_[i]);
    const Float4 costs = left.costs(area) + right_costs[i + 1];
    const Int4 is_less = costs < least;
    least = is_less ? costs : least;
    last_bins = is_less ? Int4{} + i : last_bins;
  }
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(least[axis] < best.cost)) continue;
    best.axis = axis;
    best.last_bin = last_bins[axis];
    best.cost = least[axis];
  }
  if (!best.exists()) return best;
  const auto axis = static_cast<std::size_t>(best.axis);
  for (int i = 0; i < bins; ++i) {
    const bool is_left = i <= best.last_bin;
    (is_left ? best.left : best.right).include(bins_[i].boxes[axis]);
    const Load load{.count = bins_[i].counts[best.axis], .weight = bins_[i].weights[best.axis]};
    (is_left ? best.left_load : best.right_load) += load;
  }
  return best;
}

}  // namespace microtrace::build
