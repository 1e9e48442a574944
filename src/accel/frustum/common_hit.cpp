#include "accel/frustum/common_hit.hpp"

#include "accel/build/wide/wide_tree.hpp"
#include "accel/frustum/meetings.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace microtrace {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Exceeds the rounding of products of t, and the difference of a direction's length from 1.
constexpr double kSlack = 0x1p-20;

class Search {
 public:
  Search(const Primitives& primitives, const Tree& tree, const Frustum& frustum)
      : primitives_(primitives), tree_(tree), frustum_(frustum), directions_(frustum) {
    for (int axis = 0; axis < 3; ++axis) components_[axis] = directions_.component(axis);
  }

  CommonHit run() {
    if (!(directions_.lengths().lo > 0)) return {};
    for (const PrimitiveId id : tree_.unbounded) consider(id, 0);
    if (tree_.has_leaves() && !search_tree()) return {};
    if (first_.hi < others_from_) return {.is_known = true, .id = id_};
    return {.is_known = others_from_ == kInfinity && first_.lo == kInfinity};
  }

 private:
  /// The number of nodes and leaves after which the search is no longer worth its time.
  static constexpr int kMostVisits = 4;

  /// Considers a primitive, or the part of a triangle that is in a leaf, which rays enter at t >=
  /// `from`.
  void consider(PrimitiveId id, double from) {
    const Meeting meeting = primitives_.visit(
        id, [&](const auto& shape) { return microtrace::meeting(directions_, frustum_.o, shape); });
    if (meeting.kind == Meeting::Kind::none) return;
    const Interval lengths = directions_.lengths();
    const bool is_in_range = meeting.t.lo * lengths.lo * (1 - kSlack) >= frustum_.greatest_t_min &&
                             meeting.t.hi * lengths.hi * (1 + kSlack) <= frustum_.least_t_max;
    if (meeting.kind == Meeting::Kind::all && is_in_range)
      add(id, meeting.t);
    else
      others_from_ = std::min(others_from_, std::max(meeting.t.lo, from));
  }

  void add(PrimitiveId id, const Interval& t) {
    if (id == id_ && first_.hi < kInfinity) return;  // a triangle can be in several leaves
    if (t.hi < first_.hi) {
      others_from_ = std::min(others_from_, first_.lo);
      first_ = t;
      id_ = id;
    } else {
      others_from_ = std::min(others_from_, t.lo);
    }
  }

  /// Bounds of the t at which rays are in a box; lo > hi if all miss it.
  [[nodiscard]] Interval inside(const build::Box& box) const {
    Interval t{.lo = 0, .hi = kInfinity};
    for (int axis = 0; axis < 3; ++axis) {
      Interval d = components_[axis];
      double lo = double{box.lo[axis]} - frustum_.o[axis],
             hi = double{box.hi[axis]} - frustum_.o[axis];
      if (d.hi < 0) {
        std::swap(lo, hi);
        lo = -lo;
        hi = -hi;
        d = {.lo = -d.hi, .hi = -d.lo};
      }
      if (!(d.lo > 0)) continue;
      t.lo = std::max(t.lo, (lo > 0 ? lo / d.hi : lo / d.lo) * (1 - kSlack));
      t.hi = std::min(t.hi, (hi > 0 ? hi / d.lo : hi / d.hi) * (1 + kSlack));
    }
    return t;
  }

  /// Returns false if the search would take too long.
  bool search_tree() {
    struct Entry {
      ChildRef child;
      double from;
    };
    std::array<Entry, kMostVisits * kWidth + 1> stack;
    std::size_t size = 0;
    stack[size++] = {tree_.root, 0};
    for (int visits = 0; size > 0; ++visits) {
      if (visits == kMostVisits) return false;
      const auto [child, from] = stack[--size];
      if (build::kind_of(child) == 0) {
        const WideNode& node = tree_.nodes[child];
        for (std::size_t i = 0; i < kWidth; ++i) {
          if (!build::has_child(node, i)) continue;
          const Interval t = inside(build::box_of_child(node, i));
          if (t.lo <= t.hi && t.lo <= first_.hi) stack[size++] = {node.child[i], t.lo};
        }
      } else if (build::kind_of(child) == child_ref::kTriangles) {
        visit_triangles(child, from);
      } else {
        return false;
      }
    }
    return true;
  }

  void visit_triangles(ChildRef leaf, double from) {
    const auto [begin, end] = entries_of(leaf);
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t i = 0; i < kWidth && is_used(tree_.blocks[k], i); ++i)
        consider(tree_.blocks[k].id[i], from);
  }

  const Primitives& primitives_;
  const Tree& tree_;
  const Frustum& frustum_;
  Directions directions_;
  Interval components_[3];
  /// The primitive with the least upper bound of t, its t, and the least lower bound of all others.
  PrimitiveId id_ = 0;
  Interval first_{.lo = kInfinity, .hi = kInfinity};
  double others_from_ = kInfinity;
};

}  // namespace

CommonHit common_hit(const Primitives& primitives, const Tree& tree, const Frustum& frustum) {
  return Search(primitives, tree, frustum).run();
}

}  // namespace microtrace
