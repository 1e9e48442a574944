#pragma once
/// Where the light of a scene arrives from, learned from paths.

#include "render/guiding/guide_distribution.hpp"

#include <microtrace/math.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
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

  /// A column of numbers for each component of a vector.
  using Columns = std::array<const float*, 3>;
  /// Finds the cells of surfaces at points p with the unit normals n; null where too little is
  /// known. There may be at most kMostPoints.
  void find(const Columns& p, const Columns& n, std::span<const Cell*> cells) const;
  static constexpr std::size_t kMostPoints = 16;

 private:
  class Builder;
  static constexpr std::uint32_t kNone = 0xffffffffU;

  /// A leaf is its own first child.
  struct Node {
    float split;          ///< infinite in leaves
    std::uint32_t axis;   ///< of the split
    std::uint32_t child;  ///< index of the first of two children
    std::uint32_t cell;   ///< kNone if there is none
  };
  static Node leaf(std::uint32_t index) {
    return {
        .split = std::numeric_limits<float>::infinity(), .axis = 0, .child = index, .cell = kNone};
  }

  std::vector<Node> nodes_;  // the first one for each SignedAxis is its tree's root
  std::vector<Cell> cells_;
  int depth_ = 0;
};

}  // namespace microtrace
