#pragma once
/// Checks the invariants of a bounding volume hierarchy.

#include "accel/build/tree.hpp"

#include <map>
#include <string>
#include <unordered_set>
#include <vector>

namespace microtrace {

enum class Place { nowhere, blocks, others, unbounded };

/// Visits a whole tree and records the first error.
///
/// Errors are: a box that does not contain its children or its primitives' vertices; a node, block
/// or entry that is visited twice or never; a block that does not match its triangles; a primitive
/// in two kinds of leaf. A triangle may be split among several leaves. Each point of a lattice on
/// it must then be in one of their boxes.
class TreeWalk {
 public:
  TreeWalk(const Tree& tree, const Primitives& primitives);

  [[nodiscard]] const std::string& fault() const { return fault_; }
  [[nodiscard]] int depth() const { return depth_; }  ///< number of nodes on the longest path
  /// Returns the number of triangles in blocks. A triangle counts once per leaf.
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
  std::map<PrimitiveId, std::vector<Bounds>> pieces_;  // boxes of the leaves that clip a triangle
  std::unordered_set<PrimitiveId> whole_;              // triangles that lie completely in some leaf
  std::vector<bool> nodes_, blocks_, others_;          // visited
};

/// The expected numbers of visits by a random line that hits the root's box, according to the
/// surface area heuristic.
struct TreeCost {
  double nodes = 0, blocks = 0;
  [[nodiscard]] double total() const { return 0.6 * nodes + blocks; }
};
[[nodiscard]] TreeCost cost_of(const Tree& tree);

/// Returns the cost of a simple, good tree. It splits triangles into halves of equal count along
/// the longest axis of the centroids. Each node has three levels of splits, and each leaf has up to
/// eight triangles.
[[nodiscard]] TreeCost cost_of_object_medians(const Mesh& mesh);

}  // namespace microtrace
