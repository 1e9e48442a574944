#pragma once
/// How far shapes reach in a direction.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace microtrace {

[[nodiscard]] inline bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Each is a support function: the greatest u . p of a shape's points p, for u of any length.
struct SphereSupport {
  DVec3 center;
  double radius;

  double operator()(const DVec3& u) const {
    return glm::dot(u, center) + radius * std::sqrt(glm::dot(u, u));
  }
};

struct DiscSupport {
  DVec3 center;
  DVec3 normal;  ///< of unit length
  double radius;

  double operator()(const DVec3& u) const {
    const DVec3 in_plane = glm::cross(normal, u);  // as long as u's part in the plane
    return glm::dot(u, center) + radius * std::sqrt(glm::dot(in_plane, in_plane));
  }
};

/// (p - center)^T A (p - center) = 1 with A positive definite.
struct EllipsoidSupport {
  DVec3 center;
  glm::dmat3 inverse;  ///< of A

  double operator()(const DVec3& u) const {
    return glm::dot(u, center) + std::sqrt(std::fmax(glm::dot(u, inverse * u), 0));
  }
};

/// Nothing if the quadric is no ellipsoid, or an empty one.
[[nodiscard]] std::optional<EllipsoidSupport> ellipsoid(const Quadric& quadric);

}  // namespace microtrace
