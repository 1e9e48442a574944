#include "accel/build/wide/collapse.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/layout.hpp"

namespace microtrace::build {
namespace {

struct Distribution {
  float cost;
  unsigned to_left;
};

// Returns the cheapest distribution of `parts` subtrees over the left and the right child.
Distribution best_distribution(const CollapseCosts& left, const CollapseCosts& right,
                               unsigned parts) {
  Distribution best{.cost = left[0] + right[parts - 2], .to_left = 1};
  for (unsigned k = 2; k < parts; ++k) {
    const float cost = left[k - 1] + right[parts - k - 1];
    if (cost < best.cost) best = {.cost = cost, .to_left = k};
  }
  return best;
}

float leaf_cost(const BinaryNode& node, const CollapseModel& model) {
  const float area = model.area(node.box());
  if (is_instance(node)) return area * kInstanceCost;
  const bool of_triangles = has_triangles(node, model.triangle_weight);
  const bool of_one_kind =
      of_triangles || node.weight() == node.count() * std::uint64_t{kOtherWeight};
  // More triangles would need too many blocks if they shared no vertices.
  const std::uint32_t most =
      child_ref::kMaxLeafCount * (of_triangles ? TriangleBlock::kUnshared : 1);
  if (!of_one_kind || node.count() > most) return std::numeric_limits<float>::infinity();
  return area * kBlockCost * static_cast<float>(blocks(node.weight()));
}

}  // namespace

CollapseCosts costs_of_leaf(const BinaryNode& node, const CollapseModel& model) {
  CollapseCosts costs;
  costs.fill(leaf_cost(node, model));
  return costs;
}

CollapseCosts plan_collapse(BinaryNode& node, const CollapseModel& model, const CollapseCosts& left,
                            const CollapseCosts& right) {
  const float as_leaf = leaf_cost(node, model);
  const Distribution whole = best_distribution(left, right, kWidth);
  const float as_node = model.area(node.box()) * kNodeCost + whole.cost;
  CollapsePlan plan;
  plan.set_to_left(kWidth, whole.to_left);
  plan.set_leaf(as_leaf <= as_node);
  CollapseCosts costs{std::min(as_leaf, as_node)};
  for (unsigned parts = 2; parts < kWidth; ++parts) {
    const Distribution split = best_distribution(left, right, parts);
    const bool is_better = split.cost < costs[parts - 2];
    costs[parts - 1] = is_better ? split.cost : costs[parts - 2];
    plan.set_to_left(parts, is_better ? split.to_left : 0);
  }
  node.set_plan(plan);
  return costs;
}

WideChildren::WideChildren(const BinaryNode& node) {
  const unsigned left = node.plan().to_left(kWidth);
  cut(node.children()[0], left);
  cut(node.children()[1], kWidth - left);
}

void WideChildren::cut(const BinaryNode& node, unsigned parts) {
  while (parts > 1 && node.plan().to_left(parts) == 0) --parts;
  if (parts == 1) {
    children_[count_++] = &node;
    return;
  }
  const unsigned left = node.plan().to_left(parts);
  cut(node.children()[0], left);
  cut(node.children()[1], parts - left);
}

}  // namespace microtrace::build
