#include "accel/build/binary/binary_tree.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/build/binary/cells.hpp"
#include "accel/build/binary/partition.hpp"
#include "accel/build/wide/collapse.hpp"
#include "base/system/mapped_pages.hpp"

#include <algorithm>
#include <cstddef>

namespace microtrace::build {
namespace {

// Sets of cells with at most this number of references are built by one thread each. It is a
// constant so that the tree does not depend on the number of threads.
constexpr std::size_t kSubtreeSize = std::size_t{1} << 14U;

// Sets with at most this number of references are split reference by reference, others cell by
// cell.
constexpr std::size_t kFewReferences = 1024;

// Near this depth, sets are halved without evaluating costs, so at most log2(size) more levels
// follow. Each cell counts as a full one, because cells are halved first.
constexpr unsigned kDepthLimit = 58;

// A node that is not yet split, with its cells or references. Splitting moves them within their
// range.
struct Set {
  BinaryNode* node;
  unsigned depth;
  Box centroids;
  std::span<Reference> references;
  bool of_cells;
};

int bins_for(std::size_t count, int most) {
  return static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(most), 8 + count / 4));
}

class Builder {
 public:
  Builder(Cells cells, std::uint32_t triangle_weight, int bins, WorkerPool& pool)
      : cells_(std::move(cells)), max_bins_(bins), pool_(pool) {
    tree_.ids.resize(cells_.size(cells_.all()));
    tree_.triangle_weight = model_.triangle_weight = triangle_weight;
  }

  BinaryTree build() {
    const std::vector<Set> small = split_until_small();
    tree_.subtrees.resize(small.size());
    std::vector<CollapseCosts> costs(small.size());
    pool_.run(small.size(), [&](std::size_t i) {
      tree_.subtrees[i].begin = small[i].node->begin();
      const std::size_t few = std::min<std::size_t>(kFewReferences, small[i].node->count());
      Subtree subtree{.references = PageVector<Reference>(few),
                      .scratch = PageVector<Reference>(std::max(few, small[i].references.size())),
                      .arena = tree_.subtrees[i].nodes,
                      .bins = {}};
      costs[i] = build_alone(small[i], subtree);
    });
    auto next = costs.cbegin();
    plan_top(tree_.root, next);
    return std::move(tree_);
  }

 private:
  using Halves = std::array<Set, 2>;

  /// What a thread needs to build a subtree alone.
  struct Subtree {
    PageVector<Reference> references, scratch;
    NodeArena& arena;
    Bins bins;
  };

  /// Splits the whole until each set is small enough for one thread.
  std::vector<Set> split_until_small() {
    std::vector<Set> open{whole()}, small;
    // Reused, because clearing new pages takes time.
    PageVector<std::uint16_t> scratch(open[0].references.size());
    model_.area = AreaMeasure(tree_.root.box());
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

  // Recomputes a set's boxes and weight.
  static void summarize(Set& set) {
    Box box;
    std::uint32_t weight = 0;
    set.centroids = {};
    for (const Reference& r : set.references) {
      box.include(r.box);
      set.centroids.include(centroid(r.box));
      weight += r.weight();
    }
    set.node->set(box, set.node->count(), weight);
  }

  Set whole() {
    tree_.root.set({}, static_cast<std::uint32_t>(tree_.ids.size()), 0);
    Set set{.node = &tree_.root,
            .depth = 0,
            .centroids = {},
            .references = cells_.all(),
            .of_cells = true};
    summarize(set);
    return set;
  }

  // Creates the nodes of the two parts, of which the left one has `count` cells or references. Sets
  // neither their boxes nor their weights.
  Halves halves(const Set& set, NodeArena& arena, std::size_t count) const {
    BinaryNode* const pair = arena.allocate_pair();
    const std::uint32_t begin = set.node->begin();
    const std::span<Reference> left = set.references.first(count);
    const std::uint32_t left_count =
        set.of_cells ? cells_.size(left) : static_cast<std::uint32_t>(count);
    pair[0].set_begin(begin);
    pair[0].set({}, left_count, 0);
    pair[1].set_begin(begin + left_count);
    pair[1].set({}, set.node->count() - left_count, 0);
    set.node->set_children(pair);
    Set half = set;
    ++half.depth;
    Halves sets{half, half};
    for (std::size_t i = 0; i < 2; ++i) sets[i].node = pair + i;
    sets[0].references = left;
    sets[1].references = set.references.subspan(count);
    return sets;
  }

  // Splits a set into two halves of equal count, for sets whose centroids no plane separates or
  // whose depth is near the limit.
  Halves halve(const Set& set, NodeArena& arena) {
    Halves sets = halves(set, arena, set.references.size() / 2);
    for (Set& half : sets) summarize(half);
    return sets;
  }

  // Creates the parts of a set whose references have moved.
  Halves halves(const Set& set, NodeArena& arena, const Split& split,
                const CentroidBoxes& centroids) const {
    Halves sets = halves(set, arena, split.left_load.count);
    sets[0].node->set(split.left, sets[0].node->count(), split.left_load.weight);
    sets[0].centroids = centroids.left;
    sets[1].node->set(split.right, sets[1].node->count(), split.right_load.weight);
    sets[1].centroids = centroids.right;
    return sets;
  }

  [[nodiscard]] static bool is_deep(const Set& set) {
    const std::size_t most = set.references.size() * (set.of_cells ? kCellSize : 1);
    return set.depth + static_cast<unsigned>(std::bit_width(most)) >= kDepthLimit;
  }

  Halves split_alone(const Set& set, Subtree& subtree) {
    Bins& bins = subtree.bins;
    const BinMapping mapping(set.centroids, bins_for(set.references.size(), max_bins_));
    if (is_deep(set) || mapping.is_degenerate()) return halve(set, subtree.arena);
    bins.clear(mapping.bins());
    bins.add(set.references, mapping);
    const Split split = bins.best_split(mapping.bins(), AreaMeasure(set.node->box()));
    if (!split.exists()) return halve(set, subtree.arena);
    const CentroidBoxes centroids =
        partition(set.references, mapping, split, subtree.scratch.data());
    return halves(set, subtree.arena, split, centroids);
  }

  Halves split_together(const Set& set, std::span<std::uint16_t> scratch) {
    const BinMapping mapping(set.centroids, max_bins_);
    if (is_deep(set) || mapping.is_degenerate()) return halve(set, tree_.top);
    const Chunks<Reference> chunks(set.references);
    std::vector<Bins> bins(chunks.size());
    pool_.run(bins.size(), [&](std::size_t i) {
      bins[i].clear(mapping.bins());
      bins[i].add(chunks[i], mapping);
    });
    for (std::size_t i = 1; i < bins.size(); ++i) bins[0].add(bins[i], mapping.bins());
    const Split split = bins[0].best_split(mapping.bins(), AreaMeasure(set.node->box()));
    if (!split.exists()) return halve(set, tree_.top);
    const CentroidBoxes centroids = partition_together(set.references, mapping, split,
                                                       scratch.first(set.references.size()), pool_);
    return halves(set, tree_.top, split, centroids);
  }

  // Builds and plans a subtree recursively. The recursion is at most a few levels deeper than
  // kDepthLimit.
  CollapseCosts build_alone(const Set& set, Subtree& subtree) {
    if (set.of_cells && set.node->count() <= kFewReferences)
      return build_alone(of_references(set, subtree), subtree);
    BinaryNode& node = *set.node;
    const bool is_block = has_triangles(node, tree_.triangle_weight) && blocks(node.weight()) == 1;
    if (is_block || node.count() <= 1) {
      for (std::size_t i = 0; i < set.references.size(); ++i)
        tree_.ids[node.begin() + i] = set.references[i].id();
      return costs_of_leaf(node, model_);
    }
    const Halves sets = split_alone(set, subtree);
    const CollapseCosts left = build_alone(sets[0], subtree);
    return plan_collapse(node, model_, left, build_alone(sets[1], subtree));
  }

  // Replaces a set's cells by their references.
  Set of_references(const Set& of_cells, Subtree& subtree) {
    Set set = of_cells;
    set.of_cells = false;
    set.references = std::span(subtree.references).first(set.node->count());
    cells_.take(of_cells.references, set.references.data());
    set.centroids = {};
    for (const Reference& r : set.references) set.centroids.include(centroid(r.box));
    return set;
  }

  // Plans the nodes above the subtrees, whose costs `next` yields from left to right.
  CollapseCosts plan_top(BinaryNode& node, std::vector<CollapseCosts>::const_iterator& next) {
    if (node.count() <= kSubtreeSize) return *next++;
    const CollapseCosts left = plan_top(node.children()[0], next);
    return plan_collapse(node, model_, left, plan_top(node.children()[1], next));
  }

  Cells cells_;
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

BinaryTree build_binary_tree(References references, int bins, WorkerPool& pool) {
  const std::uint32_t triangle_weight = references.triangle_weight;
  return Builder(Cells(std::move(references), pool), triangle_weight, bins, pool).build();
}

}  // namespace microtrace::build
