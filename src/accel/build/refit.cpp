#include "accel/build/refit.hpp"

#include "accel/build/area.hpp"
#include "accel/build/references/shape_box.hpp"
#include "accel/build/wide/collapse.hpp"
#include "accel/build/wide/wide_tree.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>

namespace microtrace::build {
namespace {

// Number of nodes whose leaves one thread refits at a time.
constexpr std::size_t kNodesPerJob = 1024;

class Refitter {
 public:
  Refitter(const Tree& from, const Primitives& primitives, Tree& to)
      : from_(from), primitives_(primitives), to_(to) {}

  // Refits the leaves of the nodes [first, last). Returns false if a primitive no longer belongs in
  // its leaf.
  bool fit_leaves(std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      WideNode& node = to_.nodes[n] = from_.nodes[n];
      for (std::size_t i = 0; i < kWidth; ++i) {
        if (!has_child(node, i) || kind_of(node.child[i]) == 0) continue;
        const bool fits = kind_of(node.child[i]) == child_ref::kTriangles ? fit_blocks(node, i)
                                                                          : fit_others(node, i);
        if (!fits) return false;
      }
    }
    return true;
  }

  // Refits the boxes of inner nodes from last to first, because children come after their parents.
  void fit_nodes() {
    for (std::size_t n = to_.nodes.size(); n-- > 0;) {
      WideNode& node = to_.nodes[n];
      for (std::size_t i = 0; i < kWidth; ++i) {
        if (has_child(node, i) && kind_of(node.child[i]) == 0)
          set_box(node, i, union_of_children(to_.nodes[node.child[i]]));
      }
    }
  }

 private:
  // The scene of the previous tree may have had more primitives, of which some were empty.
  [[nodiscard]] bool exists(PrimitiveId id) const { return id < primitives_.count(); }

  bool fit_blocks(WideNode& node, std::size_t i) {
    const auto [begin, end] = entries_of(node.child[i]);
    Box box;
    bool moved = false;
    for (std::size_t k = begin; k < end; ++k) {
      const TriangleBlock& old = from_.blocks[k];
      TriangleBlock& block = to_.blocks[k];
      BlockFiller filler(block);
      for (std::size_t slot = 0; slot < kWidth && is_used(old, slot); ++slot) {
        if (!exists(old.id[slot])) return false;
        const std::optional<Triangle> triangle = primitives_.triangle(old.id[slot]);
        if (!triangle || is_empty(*triangle)) return false;
        const Box own = box_of(*triangle);
        if (!fits_blocks(own) || is_point(own)) return false;
        box.include(own);
        if (!filler.add(old.id[slot], *triangle)) return false;
      }
      moved |= !have_same_vertices(old, block);
    }
    if (moved) set_box(node, i, box);
    return true;
  }

  bool fit_others(WideNode& node, std::size_t i) {
    const auto [begin, end] = entries_of(node.child[i]);
    Box box;
    for (std::size_t k = begin; k < end; ++k) {
      if (!exists(to_.others[k])) return false;
      const bool fits = primitives_.visit(to_.others[k], [&]<class AnyShape>(const AnyShape& s) {
        if constexpr (std::is_same_v<AnyShape, Plane>) {
          return false;
        } else {
          if (is_empty(s)) return false;
          const Box own = box_of(s);
          box.include(own);
          if constexpr (std::is_same_v<AnyShape, Triangle>)
            return !fits_blocks(own) || is_point(own);
          return is_finite(own);
        }
      });
      if (!fits) return false;
    }
    set_box(node, i, box);
    return true;
  }

  const Tree& from_;
  const Primitives& primitives_;
  Tree& to_;
};

// Compares each cost with its value when the tree was built. Also returns false if all areas are
// zero, because the costs are then NaN or infinite.
bool grows_at_most(double growth, const RelativeCost& from, const RelativeCost& to) {
  return to.to_tree / from.to_tree <= growth && to.to_primitives / from.to_primitives <= growth;
}

}  // namespace

std::optional<Tree> refitted(const Tree& previous, const References& references,
                             const Primitives& primitives, double max_growth, WorkerPool& pool) {
  if (previous.nodes.empty() || previous.primitives != references.items.size()) return std::nullopt;
  Tree tree;
  tree.root = previous.root;
  tree.others = previous.others;
  tree.primitives = previous.primitives;
  tree.area = references.area;
  tree.built_cost = previous.built_cost ? previous.built_cost : relative_cost(previous);
  tree.nodes.resize(previous.nodes.size());
  tree.blocks.resize(previous.blocks.size());
  Refitter refitter(previous, primitives, tree);
  std::atomic<bool> fits = true;
  pool.run((tree.nodes.size() + kNodesPerJob - 1) / kNodesPerJob, [&](std::size_t job) {
    const std::size_t first = job * kNodesPerJob;
    if (fits && !refitter.fit_leaves(first, std::min(first + kNodesPerJob, tree.nodes.size())))
      fits = false;
  });
  if (!fits) return std::nullopt;
  refitter.fit_nodes();
  tree.bounds = bounds_of(union_of_children(tree.nodes[tree.root]));
  if (!grows_at_most(max_growth, *tree.built_cost, relative_cost(tree))) return std::nullopt;
  return tree;
}

RelativeCost relative_cost(const Tree& tree) {
  double sum = 0;
  for (const WideNode& node : tree.nodes) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      if (!has_child(node, i)) continue;
      const double area =
          half_area(double{node.hi_x[i]} - node.lo_x[i], double{node.hi_y[i]} - node.lo_y[i],
                    double{node.hi_z[i]} - node.lo_z[i]);
      const auto [begin, end] = entries_of(node.child[i]);
      const bool is_leaf = kind_of(node.child[i]) != 0;
      sum += area * (is_leaf ? kBlockCost * static_cast<float>(end - begin) : kNodeCost);
    }
  }
  const DVec3 size = DVec3(tree.bounds.hi) - DVec3(tree.bounds.lo);
  return {.to_tree = sum / half_area(size.x, size.y, size.z), .to_primitives = sum / tree.area};
}

}  // namespace microtrace::build
