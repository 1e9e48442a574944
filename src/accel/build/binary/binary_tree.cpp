#include "accel/build/binary/binary_tree.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/build/binary/partition.hpp"
#include "accel/build/wide/collapse.hpp"
#include "base/mapped_pages.hpp"
#include "base/release.hpp"

#include <algorithm>
#include <cstddef>

namespace microtrace::build {
namespace {

// Sets of at most this number of references are built by one thread each. It is a constant so that
// the tree does not depend on the number of threads.
constexpr std::size_t kSubtreeSize = std::size_t{1} << 14U;

// Near this depth, sets are halved without evaluating costs, so at most log2(size) more levels
// follow.
constexpr unsigned kDepthLimit = 58;

// A node that is not yet split. Splitting moves its references within their range.
struct Set {
  BinaryNode* node;
  unsigned depth;
  Box centroids;
};

int bins_for(std::size_t count, int most) {
  return static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(most), 8 + count / 4));
}

class Builder {
 public:
  Builder(PageVector<Reference> references, std::uint32_t triangle_weight, int bins,
          WorkerPool& pool)
      : references_(std::move(references)), max_bins_(bins), pool_(pool) {
    tree_.ids.resize(references_.size());
    tree_.triangle_weight = model_.triangle_weight = triangle_weight;
  }

  BinaryTree build() {
    const std::vector<Set> small = split_until_small();
    tree_.subtrees.resize(small.size());
    std::vector<CollapseCosts> costs(small.size());
    Release<Reference> release(references_);
    pool_.run(small.size(), [&](std::size_t i) {
      const BinaryNode& node = *small[i].node;
      tree_.subtrees[i].begin = node.begin;
      PageVector<std::byte> scratch(kSubtreeSize * sizeof(Reference));
      Subtree subtree{.scratch = reinterpret_cast<Reference*>(scratch.data()),
                      .arena = tree_.subtrees[i].nodes,
                      .bins = {}};
      costs[i] = build_alone(small[i], subtree);
      release(node.begin, node.count());
    });
    auto next = costs.cbegin();
    plan_top(tree_.root, next);
    return std::move(tree_);
  }

 private:
  using Halves = std::array<Set, 2>;

  /// What a thread needs to build a subtree alone.
  struct Subtree {
    Reference* scratch;
    NodeArena& arena;
    Bins bins;
  };

  [[nodiscard]] std::span<Reference> of(const Set& set) {
    return std::span(references_).subspan(set.node->begin, set.node->count());
  }

  /// Splits the whole until each set is small enough for one thread.
  std::vector<Set> split_until_small() {
    std::vector<Set> open{whole()}, small;
    // Reused, because clearing new pages takes time.
    PageVector<std::uint16_t> scratch(references_.size() > kSubtreeSize ? references_.size() : 0);
    model_.area = AreaMeasure(tree_.root.box);
    while (!open.empty()) {
      const Set set = open.back();
      open.pop_back();
      if (set.node->count() <= kSubtreeSize) {
        small.push_back(set);
        continue;
      }
      const auto [left, right] = split_together(set, scratch);
      open.push_back(right);
      open.push_back(left);
    }
    return small;
  }

  // Computes a set's boxes, count and weight.
  static void summarize(std::span<const Reference> references, Set& set) {
    Box box;
    std::uint32_t weight = 0;
    set.centroids = {};
    for (const Reference& r : references) {
      box.include(r.box);
      set.centroids.include(centroid(r.box));
      weight += r.weight();
    }
    set.node->set(box, static_cast<std::uint32_t>(references.size()), weight);
  }

  Set whole() {
    Set set{.node = &tree_.root, .depth = 0, .centroids = {}};
    summarize(references_, set);
    return set;
  }

  // Creates the nodes of the two parts and sets all data that the split provides.
  static Halves halves(const Set& set, NodeArena& arena, const Split& split) {
    BinaryNode* pair = set.node->children = arena.allocate_pair();
    pair[0].set(split.left, split.left_load.count, split.left_load.weight);
    pair[0].begin = set.node->begin;
    pair[1].set(split.right, split.right_load.count, split.right_load.weight);
    pair[1].begin = set.node->begin + split.left_load.count;
    return {Set{.node = pair, .depth = set.depth + 1, .centroids = {}},
            Set{.node = pair + 1, .depth = set.depth + 1, .centroids = {}}};
  }

  // Splits a set into two halves of equal count, for sets whose centroids no plane separates or
  // whose depth is near the limit.
  Halves halve(const Set& set, NodeArena& arena) {
    Split split;
    split.left_load.count = set.node->count() / 2;
    split.right_load.count = set.node->count() - split.left_load.count;
    Halves sets = halves(set, arena, split);
    for (Set& half : sets) summarize(of(half), half);
    return sets;
  }

  [[nodiscard]] static bool is_deep(const Set& set) {
    return set.depth + static_cast<unsigned>(std::bit_width(set.node->count())) >= kDepthLimit;
  }

  Halves split_alone(const Set& set, Subtree& subtree) {
    auto& [scratch, arena, bins] = subtree;
    const BinMapping mapping(set.centroids, bins_for(set.node->count(), max_bins_));
    if (is_deep(set) || mapping.is_degenerate()) return halve(set, arena);
    bins.clear(mapping.bins());
    bins.add(of(set), mapping);
    const Split split = bins.best_split(mapping.bins(), AreaMeasure(set.node->box));
    if (!split.exists()) return halve(set, arena);
    return with_centroids(halves(set, arena, split), partition(of(set), mapping, split, scratch));
  }

  Halves split_together(const Set& set, std::span<std::uint16_t> scratch) {
    const BinMapping mapping(set.centroids, max_bins_);
    if (is_deep(set) || mapping.is_degenerate()) return halve(set, tree_.top);
    const Chunks<Reference> chunks(of(set));
    std::vector<Bins> bins(chunks.size());
    pool_.run(bins.size(), [&](std::size_t i) {
      bins[i].clear(mapping.bins());
      bins[i].add(chunks[i], mapping);
    });
    for (std::size_t i = 1; i < bins.size(); ++i) bins[0].add(bins[i], mapping.bins());
    const Split split = bins[0].best_split(mapping.bins(), AreaMeasure(set.node->box));
    if (!split.exists()) return halve(set, tree_.top);
    return with_centroids(
        halves(set, tree_.top, split),
        partition_together(of(set), mapping, split, scratch.first(set.node->count()), pool_));
  }

  static Halves with_centroids(Halves sets, const CentroidBoxes& centroids) {
    sets[0].centroids = centroids.left;
    sets[1].centroids = centroids.right;
    return sets;
  }

  // Builds and plans a subtree recursively. The recursion is at most a few levels deeper than
  // kDepthLimit.
  CollapseCosts build_alone(const Set& set, Subtree& subtree) {
    BinaryNode& node = *set.node;
    const bool is_block = has_triangles(node, tree_.triangle_weight) && blocks(node.weight()) == 1;
    if (is_block || node.count() <= 1) {
      const auto leaf = of(set);
      for (std::size_t i = 0; i < leaf.size(); ++i) tree_.ids[node.begin + i] = leaf[i].id();
      return costs_of_leaf(node, model_);
    }
    const Halves sets = split_alone(set, subtree);
    const CollapseCosts left = build_alone(sets[0], subtree);
    return plan_collapse(node, model_, left, build_alone(sets[1], subtree));
  }

  // Plans the nodes above the subtrees, whose costs `next` yields from left to right.
  CollapseCosts plan_top(BinaryNode& node, std::vector<CollapseCosts>::const_iterator& next) {
    if (node.count() <= kSubtreeSize) return *next++;
    const CollapseCosts left = plan_top(node.children[0], next);
    return plan_collapse(node, model_, left, plan_top(node.children[1], next));
  }

  PageVector<Reference> references_;
  BinaryTree tree_;
  CollapseModel model_;
  int max_bins_;
  WorkerPool& pool_;
};

}  // namespace

BinaryNode* NodeArena::allocate_pair() {
  if (used_ == kChunk) {
    chunks_.emplace_back(static_cast<BinaryNode*>(map_pages(kChunk * sizeof(BinaryNode))));
    used_ = 0;
  }
  used_ += 2;
  BinaryNode* const pair = &chunks_.back()[used_ - 2];
  std::construct_at(pair);
  std::construct_at(pair + 1);
  return pair;
}

void NodeArena::Unmap::operator()(BinaryNode* chunk) const {
  unmap_pages(chunk, kChunk * sizeof(BinaryNode));
}

BinaryTree build_binary_tree(PageVector<Reference> references, std::uint32_t triangle_weight,
                             int bins, WorkerPool& pool) {
  return Builder(std::move(references), triangle_weight, bins, pool).build();
}

}  // namespace microtrace::build
