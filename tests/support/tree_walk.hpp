#pragma once
/// Checks the invariants of a tree.

#include "accel/build/tree.hpp"

#include <map>
#include <string>
#include <unordered_set>
#include <vector>

namespace microtrace {

enum class Place { nowhere, blocks, others, unbounded };

/// Visits a whole tree and records the first error: a box that does not contain its children or its
/// primitives' vertices, a node, block or entry visited twice or never, a block that does not match
/// its triangles, a primitive in two kinds of leaf. A triangle may be in several leaves; then a
/// lattice of its points must be in their boxes.
class TreeWalk {
 public:
  TreeWalk(const Tree& tree, const Primitives& primitives);

  [[nodiscard]] const std::string& fault() const { return fault_; }
  [[nodiscard]] int depth() const { return depth_; }  ///< nodes on the longest path
  /// Triangles in blocks, counted once per leaf.
  [[nodiscard]] std::size_t triangle_references() const { return triangle_references_; }
  [[nodiscard]] Place place(PrimitiveId id) const {
    return id < places_.size() ? places_[id] : Place::nowhere;
  }

 private:
  void visit(ChildRef ref, const Bounds& box, int depth);
  void visit_block(const TriangleBlock& block, const Bounds& box);
  void put(PrimitiveId id, Place place);
  void check_pieces();
  void expect(bool good, const std::string& what);

  const Tree& tree_;
  const Primitives& primitives_;
  std::string fault_;
  int depth_ = 0;
  std::vector<Place> places_;
  std::size_t triangle_references_ = 0;
  std::map<PrimitiveId, std::vector<Bounds>> pieces_;  // leaves that contain only a part of a
                                                       // triangle
  std::unordered_set<PrimitiveId> whole_;              // triangles that some leaf contains
                                                       // completely
  std::vector<bool> nodes_, blocks_, others_;          // visited
};

/// The expected number of visits of a random line that hits the root's box, by the surface area
/// heuristic.
struct TreeCost {
  double nodes = 0, blocks = 0;
  [[nodiscard]] double total() const { return 0.6 * nodes + blocks; }
};
[[nodiscard]] TreeCost cost_of(const Tree& tree);

/// The cost of a simple good tree: splits in halves by count along the longest axis of the
/// centroids, nodes of three such levels, leaves of eight.
[[nodiscard]] TreeCost cost_of_object_medians(const Mesh& mesh);

}  // namespace microtrace
