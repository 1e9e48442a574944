#include "accel/build/binary/binning.hpp"

namespace microtrace::build {
namespace {

// The expected number of blocks of a set that will be split further. It exceeds weight / 16,
// because splits often leave blocks partly filled.
float expected_blocks(const Load& load) {
  return static_cast<float>(blocks(load.weight)) + 0.05F * static_cast<float>(load.weight);
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
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(boxes_[axis], bins, Box());
    std::fill_n(loads_[axis], bins, Load());
  }
}

void Bins::add(std::span<const Reference> references, const BinMapping& mapping) {
  for (const Reference& r : references) {
    prefetch_after(r);
    const Int4 bin = mapping(r);
    const Load load{.count = 1, .weight = r.weight()};
    for (int axis = 0; axis < 3; ++axis) {
      boxes_[axis][bin[axis]].include(r.box);
      loads_[axis][bin[axis]] += load;
    }
  }
}

void Bins::add(const Bins& other, int bins) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < bins; ++i) {
      boxes_[axis][i].include(other.boxes_[axis][i]);
      loads_[axis][i] += other.loads_[axis][i];
    }
  }
}

Load Bins::load_up_to(int axis, int last_bin) const {
  Load load;
  for (int i = 0; i <= last_bin; ++i) load += loads_[axis][i];
  return load;
}

void Bins::try_axis(int axis, int bins, const AreaMeasure& area, Split& best) const {
  const auto& boxes = boxes_[axis];
  const auto& loads = loads_[axis];
  float right_cost[kMaxBins];  // right_cost[i] is the cost of bins i and above
  Box box;
  Load load;
  for (int i = bins - 1; i > 0; --i) {
    box.include(boxes[i]);
    load += loads[i];
    right_cost[i] = load.count == 0 ? std::numeric_limits<float>::infinity()
                                    : area(box) * expected_blocks(load);
  }
  box = {};
  load = {};
  for (int i = 0; i + 1 < bins; ++i) {
    box.include(boxes[i]);
    load += loads[i];
    if (load.count == 0) continue;
    const float cost = area(box) * expected_blocks(load) + right_cost[i + 1];
    if (cost < best.cost) {
      best.cost = cost;
      best.axis = axis;
      best.last_bin = i;
    }
  }
}

Split Bins::best_split(int bins, const AreaMeasure& area) const {
  Split best;
  for (int axis = 0; axis < 3; ++axis) try_axis(axis, bins, area, best);
  if (!best.exists()) return best;
  for (int i = 0; i < bins; ++i) {
    const bool left = i <= best.last_bin;
    (left ? best.left : best.right).include(boxes_[best.axis][i]);
    (left ? best.left_load : best.right_load) += loads_[best.axis][i];
  }
  return best;
}

}  // namespace microtrace::build
