#pragma once
/// Selects one of many lights (A. Conty Estevez and C. Kulla, Importance sampling of many lights
/// with adaptive tree splitting, 2018). The selection descends a tree of boxes and cones from the
/// root to one light. The probability of each child is proportional to an upper bound of its
/// contribution.

#include "render/lights/light_importance.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/common.hpp>

namespace microtrace {

/// A cone of normals within the angle theta_o of an axis. Lights emit at angles up to theta_e from
/// each normal. theta_o + theta_e is at most pi.
struct LightCone {
  Vec3 axis{0, 0, 1};  ///< unit length
  float cos_o = 1;     ///< cosine of theta_o; -1 for all directions
  float cos_e = 0;
};

/// Bounds of the position, direction and power of lights.
struct LightBounds {
  Vec3 low{0}, high{0};  ///< world space
  double power = 0;
  LightCone cone{};
  bool two_sided = false;  ///< true if the lights also emit around -axis
};

/// The finite float32 point that is nearest to p.
[[nodiscard]] inline Vec3 finite_point(const DVec3& p) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return Vec3(glm::clamp(p, DVec3(-kMost), DVec3(kMost)));
}

/// The tree of lights. Immutable; any number of threads may use it.
class LightTree {
 public:
  /// Builds the tree from the bounds of at least one light. Each power must be positive. Lights
  /// keep their indices.
  explicit LightTree(const std::vector<LightBounds>& lights);

  /// The nodes, starting with the root.
  [[nodiscard]] const LightNode* nodes() const { return nodes_.data(); }
  [[nodiscard]] const LightTreeSpace& space() const { return space_; }

  /// The probability with which choose_light() selects this light at a point in world space.
  [[nodiscard]] float probability(std::size_t light, const Vec3& p, const Vec3& n) const;

 private:
  struct Range;  // a range of lights, which become one node

  void build(const std::vector<LightBounds>& lights, std::vector<std::uint32_t>& order,
             const Range& range);

  LightTreeSpace space_;
  std::vector<LightNode> nodes_;
  /// The path from the root to each light, with one bit per level, lowest bit first. A set bit
  /// means the second child.
  std::vector<std::uint64_t> trails_;
};

}  // namespace microtrace
