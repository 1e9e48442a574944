#pragma once
/// Where the light of a scene arrives from, learned from paths.

#include "render/guiding/guide_distribution.hpp"

#include <microtrace/math.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// A vertex of a training path: the light that arrived there from one direction.
struct GuideRecord {
  Vec3 p;       ///< the vertex
  Vec3 d;       ///< unit direction from which the light arrived
  float value;  ///< luminance times cosine, divided by the pdf of the direction
};

/// The records of vertices by the SignedAxis that is nearest to their normal.
using GuideRecords = std::array<std::vector<GuideRecord>, 6>;

[[nodiscard]] inline std::size_t face_index(const SignedAxis& axis) {
  return static_cast<std::size_t>(2 * axis.axis + (axis.is_down ? 1 : 0));
}

/// For parts of space, and each SignedAxis toward which surfaces face, a pdf of directions in
/// proportion to the light that arrives times the cosine. Space is divided by binary trees, finely
/// where many training paths had vertices (T. Müller, M. Gross and J. Novák, Practical path guiding
/// for efficient light-transport simulation, 2017). Immutable; any number of threads may use it.
class PathGuide {
 public:
  /// `brightness` is the mean luminance of the picture. The result depends only on the set of
  /// records, not on their order.
  PathGuide(GuideRecords records, float brightness);

  struct Cell {
    GuideDistribution directions;
    /// The luminance of a white diffuse surface, divided by that of the picture.
    float brightness;
  };

  /// The cell of surfaces at p with the unit normal n; null if too little is known.
  [[nodiscard]] const Cell* at(const Vec3& p, const Vec3& n) const {
    std::uint32_t index = roots_[face_index(SignedAxis::nearest(n))];
    while (nodes_[index].axis < 3) {
      const Node& node = nodes_[index];
      index = node.child + (p[node.axis] < node.split ? 0 : 1);
    }
    const std::uint32_t cell = nodes_[index].child;
    return cell == kNone ? nullptr : &cells_[cell];
  }

 private:
  class Builder;
  static constexpr std::uint32_t kNone = 0xffffffffU;

  struct Node {
    float split = 0;
    std::uint32_t child = kNone;  ///< index of the first of two children; of a cell if axis is 3
    std::int32_t axis = 3;        ///< axis of the split; 3 for leaves
  };

  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
  std::array<std::uint32_t, 6> roots_{};
};

}  // namespace microtrace
