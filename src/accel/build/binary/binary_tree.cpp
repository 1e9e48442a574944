#include "accel/build/binary/binary_tree.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/build/wide/collapse.hpp"
#include "base/mapped_pages.hpp"

#include <algorithm>

namespace microtrace::build {
namespace {

// kChunkSize is the number of references per task while all threads split one set together. Sets of
// at most kSubtreeSize references are built by one thread each. These are constants so that the
// tree does not depend on the number of threads.
constexpr std::size_t kChunkSize = std::size_t{1} << 13U;
constexpr std::size_t kSubtreeSize = std::size_t{1} << 14U;

// Near this depth, sets are halved without evaluating costs, so at most log2(size) more levels
// follow.
constexpr unsigned kDepthLimit = 58;

// The references of a node that is not yet split. They are stored in one of two arrays, in the
// range that they keep in the final order. Splitting moves them to the other array.
struct Set {
  BinaryNode* node;
  unsigned depth, array;
  Box centroids;
};

// The two arrays, or the parts of them from the position `first` on.
struct Arrays {
  std::array<Reference*, 2> data;
  std::uint32_t first = 0;

  [[nodiscard]] std::span<Reference> of(const Set& set) const {
    return {data[set.array] + (set.node->begin - first), set.node->count};
  }
};

struct CentroidBoxes {
  Box left, right;

  void include(const CentroidBoxes& b) {
    left.include(b.left);
    right.include(b.right);
  }
};

// Copies each reference to the left or the right output without a branch, which would be
// unpredictable.
CentroidBoxes partition(std::span<const Reference> from, const BinMapping& mapping,
                        const Split& split, Reference* left, Reference* right) {
  const float infinity = std::numeric_limits<float>::infinity();
  CentroidBoxes boxes;
  std::array<Reference*, 2> to{left, right};
  for (const Reference& r : from) {
    prefetch_after(r);
    const bool goes_right = mapping(r)[split.axis] > split.last_bin;
    *to[goes_right]++ = r;
    const Float4 c = centroid(r.box);
    const Int4 is_right = splat(static_cast<float>(goes_right)) > splat(0.5F);
    boxes.left.lo = min(boxes.left.lo, is_right ? splat(infinity) : c);
    boxes.left.hi = max(boxes.left.hi, is_right ? splat(-infinity) : c);
    boxes.right.lo = min(boxes.right.lo, is_right ? c : splat(infinity));
    boxes.right.hi = max(boxes.right.hi, is_right ? c : splat(-infinity));
  }
  return boxes;
}

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
    pool_.run(small.size(), [&](std::size_t i) {
      const BinaryNode& node = *small[i].node;
      tree_.subtrees[i].begin = node.begin;
      PageVector<Reference> other(node.count);
      Subtree subtree{
          .arrays = {.data = {references_.data() + node.begin, other.data()}, .first = node.begin},
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
    Arrays arrays;
    NodeArena& arena;
    Bins bins;
  };

  /// Splits the whole until each set is small enough for one thread. Their references are then all
  /// in the first array, so that the second needs no memory any longer.
  std::vector<Set> split_until_small() {
    PageVector<Reference> other(references_.size() > kSubtreeSize ? references_.size() : 0);
    const Arrays arrays{.data = {references_.data(), other.data()}};
    std::vector<Set> open{whole(arrays)}, small;
    model_.area = AreaMeasure(tree_.root.box);
    while (!open.empty()) {
      const Set set = open.back();
      open.pop_back();
      if (set.node->count <= kSubtreeSize) {
        small.push_back(set);
        continue;
      }
      const auto [left, right] = split_together(set, arrays);
      open.push_back(right);
      open.push_back(left);
    }
    pool_.run(small.size(), [&](std::size_t i) {
      if (small[i].array == 0) return;
      const std::span<Reference> moved = arrays.of(small[i]);
      small[i].array = 0;
      std::ranges::copy(moved, arrays.of(small[i]).begin());
    });
    return small;
  }

  // Recomputes a set's boxes and weight.
  static void summarize(std::span<const Reference> references, Set& set) {
    set.node->box = set.centroids = {};
    set.node->weight = 0;
    for (const Reference& r : references) {
      set.node->box.include(r.box);
      set.centroids.include(centroid(r.box));
      set.node->weight += r.weight();
    }
  }

  Set whole(const Arrays& arrays) {
    tree_.root.count = static_cast<std::uint32_t>(references_.size());
    Set set{.node = &tree_.root, .depth = 0, .array = 0, .centroids = {}};
    summarize(arrays.of(set), set);
    return set;
  }

  // Creates the nodes of the two parts and sets all data that the split provides.
  static Halves halves(const Set& set, NodeArena& arena, const Split& split) {
    BinaryNode* pair = set.node->children = arena.allocate_pair();
    pair[0].box = split.left;
    pair[0].begin = set.node->begin;
    pair[0].count = split.left_load.count;
    pair[0].weight = split.left_load.weight;
    pair[1].box = split.right;
    pair[1].begin = set.node->begin + pair[0].count;
    pair[1].count = split.right_load.count;
    pair[1].weight = split.right_load.weight;
    Set half{.node = pair, .depth = set.depth + 1, .array = 1 - set.array, .centroids = {}};
    Set other = half;
    other.node = pair + 1;
    return {half, other};
  }

  // Splits a set into two halves of equal count, for sets whose centroids no plane separates or
  // whose depth is near the limit.
  static Halves halve(const Set& set, const Arrays& arrays, NodeArena& arena) {
    Split split;
    split.left_load.count = set.node->count / 2;
    split.right_load.count = set.node->count - split.left_load.count;
    Halves sets = halves(set, arena, split);
    for (Set& half : sets) {
      half.array = set.array;
      summarize(arrays.of(half), half);
    }
    return sets;
  }

  [[nodiscard]] static bool is_deep(const Set& set) {
    return set.depth + static_cast<unsigned>(std::bit_width(set.node->count)) >= kDepthLimit;
  }

  Halves split_alone(const Set& set, Subtree& subtree) const {
    auto& [arrays, arena, bins] = subtree;
    const BinMapping mapping(set.centroids, bins_for(set.node->count, max_bins_));
    if (is_deep(set) || mapping.is_degenerate()) return halve(set, arrays, arena);
    bins.clear(mapping.bins());
    bins.add(arrays.of(set), mapping);
    const Split split = bins.best_split(mapping.bins(), AreaMeasure(set.node->box));
    if (!split.exists()) return halve(set, arrays, arena);
    Halves sets = halves(set, arena, split);
    const CentroidBoxes centroids = partition(arrays.of(set), mapping, split,
                                              arrays.of(sets[0]).data(), arrays.of(sets[1]).data());
    sets[0].centroids = centroids.left;
    sets[1].centroids = centroids.right;
    return sets;
  }

  Halves split_together(const Set& set, const Arrays& arrays) {
    const BinMapping mapping(set.centroids, max_bins_);
    if (is_deep(set) || mapping.is_degenerate()) return halve(set, arrays, tree_.top);
    const std::span<const Reference> all = arrays.of(set);
    const std::size_t chunks = (all.size() + kChunkSize - 1) / kChunkSize;
    const auto chunk = [&](std::size_t i) {
      return all.subspan(i * kChunkSize, std::min(kChunkSize, all.size() - i * kChunkSize));
    };
    std::vector<Bins> bins(chunks);
    pool_.run(chunks, [&](std::size_t i) {
      bins[i].clear(mapping.bins());
      bins[i].add(chunk(i), mapping);
    });
    Bins sum = bins[0];
    for (std::size_t i = 1; i < chunks; ++i) sum.add(bins[i], mapping.bins());
    const Split split = sum.best_split(mapping.bins(), AreaMeasure(set.node->box));
    if (!split.exists()) return halve(set, arrays, tree_.top);

    Halves sets = halves(set, tree_.top, split);
    std::vector<std::size_t> left_before(chunks);
    std::size_t left = 0;
    for (std::size_t i = 0; i < chunks; ++i) {
      left_before[i] = left;
      left += bins[i].load_up_to(split.axis, split.last_bin).count;
    }
    std::vector<CentroidBoxes> centroids(chunks);
    pool_.run(chunks, [&](std::size_t i) {
      centroids[i] = partition(chunk(i), mapping, split, arrays.of(sets[0]).data() + left_before[i],
                               arrays.of(sets[1]).data() + (i * kChunkSize - left_before[i]));
    });
    for (std::size_t i = 1; i < chunks; ++i) centroids[0].include(centroids[i]);
    sets[0].centroids = centroids[0].left;
    sets[1].centroids = centroids[0].right;
    return sets;
  }

  // Builds and plans a subtree recursively. The recursion is at most a few levels deeper than
  // kDepthLimit.
  CollapseCosts build_alone(const Set& set, Subtree& subtree) {
    BinaryNode& node = *set.node;
    const bool is_block = has_triangles(node, tree_.triangle_weight) && blocks(node.weight) == 1;
    if (is_block || node.count <= 1) {
      const auto leaf = subtree.arrays.of(set);
      for (std::size_t i = 0; i < leaf.size(); ++i) tree_.ids[node.begin + i] = leaf[i].id();
      return costs_of_leaf(node, model_);
    }
    const Halves sets = split_alone(set, subtree);
    const CollapseCosts left = build_alone(sets[0], subtree);
    return plan_collapse(node, model_, left, build_alone(sets[1], subtree));
  }

  // Plans the nodes above the subtrees, whose costs `next` yields from left to right.
  CollapseCosts plan_top(BinaryNode& node, std::vector<CollapseCosts>::const_iterator& next) {
    if (node.count <= kSubtreeSize) return *next++;
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
