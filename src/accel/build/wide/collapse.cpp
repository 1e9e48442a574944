#include "accel/build/wide/collapse.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/layout.hpp"

namespace microtrace::build {
namespace {

struct Distribution {
  float cost;
  std::uint8_t to_left;
};

// Returns the cheapest distribution of `parts` subtrees over the left and the right child.
Distribution best_distribution(const CollapsePlan& left, const CollapsePlan& right,
                               unsigned parts) {
  Distribution best{.cost = left.cost[0] + right.cost[parts - 2], .to_left = 1};
  for (unsigned k = 2; k < parts; ++k) {
    const float cost = left.cost[k - 1] + right.cost[parts - k - 1];
    if (cost < best.cost) best = {.cost = cost, .to_left = static_cast<std::uint8_t>(k)};
  }
  return best;
}

float leaf_cost(const BinaryNode& node, float area) {
  if (is_instance(node)) return area * kInstanceCost;
  const std::uint32_t entries = blocks(node.weight);
  const bool of_one_kind = node.weight == node.count * kTriangleWeight ||
                           node.weight == node.count * std::uint64_t{kOtherWeight};
  if (!of_one_kind || entries > child_ref::kMaxLeafCount)
    return std::numeric_limits<float>::infinity();
  return area * kBlockCost * static_cast<float>(entries);
}

}  // namespace

void plan_collapse(BinaryNode& node, const AreaMeasure& area) {
  CollapsePlan& plan = node.plan;
  const float own_area = area(node.box), as_leaf = leaf_cost(node, own_area);
  if (node.children == nullptr) {
    plan.cost.fill(as_leaf);
    return;
  }
  const CollapsePlan &left = node.children[0].plan, &right = node.children[1].plan;
  const Distribution whole = best_distribution(left, right, kWidth);
  const float as_node = own_area * kNodeCost + whole.cost;
  plan.to_left[kWidth] = whole.to_left;
  plan.is_leaf = as_leaf <= as_node;
  plan.cost[0] = plan.is_leaf ? as_leaf : as_node;
  for (unsigned parts = 2; parts < kWidth; ++parts) {
    const Distribution split = best_distribution(left, right, parts);
    const bool better = split.cost < plan.cost[parts - 2];
    plan.cost[parts - 1] = better ? split.cost : plan.cost[parts - 2];
    plan.to_left[parts] = better ? split.to_left : std::uint8_t{0};
  }
}

WideChildren::WideChildren(const BinaryNode& node) {
  const unsigned left = node.plan.to_left[kWidth];
  cut(node.children[0], left);
  cut(node.children[1], kWidth - left);
}

void WideChildren::cut(const BinaryNode& node, unsigned parts) {
  while (parts > 1 && node.plan.to_left[parts] == 0) --parts;
  if (parts == 1) {
    children_[count_++] = &node;
    return;
  }
  const unsigned left = node.plan.to_left[parts];
  cut(node.children[0], left);
  cut(node.children[1], parts - left);
}

}  // namespace microtrace::build
