#include "accel/build/tree.hpp"

#include "accel/build/binning.hpp"
#include "accel/build/collapse.hpp"
#include "accel/build/presplit.hpp"
#include "accel/build/reference.hpp"
#include "accel/build/tree_writer.hpp"

namespace microtrace {
namespace {

using namespace build;

constexpr int kBinsForPreview = 8;

// For fewer references, starting threads takes longer than it saves.
constexpr std::size_t kWorthThreads = 20000;

void plan(BinaryTree& binary, WorkerPool& pool) {
  const AreaMeasure area(binary.root.box);
  const auto plan_node = [&](BinaryNode& node) { plan_collapse(node, area); };
  pool.run(binary.subtrees.size(),
           [&](std::size_t i) { binary.subtrees[i].for_each_backwards(plan_node); });
  binary.top.for_each_backwards(plan_node);
  plan_node(binary.root);
}

}  // namespace

Tree build_tree(const Primitives& primitives, const BuildOptions& options) {
  References references = gather(primitives);
  Tree tree;
  tree.duplicates = Duplicates(references, primitives);
  references.hashes = {};
  set_points_apart(references.bounded);
  if (!options.fast) presplit(references.bounded, primitives);
  tree.unbounded = std::move(references.unbounded);
  WorkerPool pool(references.bounded.size() < kWorthThreads ? 1 : options.threads);
  BinaryTree binary = build_binary_tree(std::move(references.bounded),
                                        options.fast ? kBinsForPreview : kMaxBins, pool);
  if (binary.ids.empty()) {
    tree.nodes.push_back(empty_node());
    return tree;
  }
  plan(binary, pool);
  write_tree(binary, primitives, pool, tree);
  const Box& box = binary.root.box;
  tree.bounds = {.lo = {box.lo[0], box.lo[1], box.lo[2]}, .hi = {box.hi[0], box.hi[1], box.hi[2]}};
  return tree;
}

}  // namespace microtrace
