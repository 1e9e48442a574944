#pragma once
/// Looks at a tree from outside.

#include "accel/build/tree.hpp"

#include <map>
#include <string>
#include <unordered_set>
#include <vector>

namespace microtrace {

enum class Place { nowhere, blocks, others, unbounded };

/// Visits all of a tree and notes the first thing that is wrong with it: a box that does not hold
/// its children's or its primitives' corners, a node, block or entry reached twice or never, a
/// block that is not what its triangles make it, a primitive in two kinds of leaf. A triangle may
/// be in several leaves: then a lattice of its points must lie in their boxes.
class TreeWalk {
 public:
  TreeWalk(const Tree& tree, const Primitives& primitives);

  [[nodiscard]] const std::string& fault() const { return fault_; }
  [[nodiscard]] int depth() const { return depth_; }  ///< nodes on the longest path
  /// Of triangles in blocks, counted once for each leaf.
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
  std::map<PrimitiveId, std::vector<Bounds>> pieces_;  // leaves that do not hold a whole triangle
  std::unordered_set<PrimitiveId> whole_;              // triangles that some leaf holds
  std::vector<bool> nodes_, blocks_, others_;          // visited
};

/// Expected visits of a long random ray that meets the root's box: the surface area heuristic.
struct TreeCost {
  double nodes = 0, blocks = 0;
  [[nodiscard]] double total() const { return 0.6 * nodes + blocks; }
};
[[nodiscard]] TreeCost cost_of(const Tree& tree);

/// Of the plainest good tree: halves by count across the longest axis of the centroids, nodes of
/// three levels of that, leaves of eight.
[[nodiscard]] TreeCost cost_of_object_medians(const Mesh& mesh);

}  // namespace microtrace
