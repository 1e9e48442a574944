#pragma once
/// Support functions and bounds of shapes.

#include "base/finite.hpp"
#include "scene/mesh/mesh_chunks.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cmath>
#include <optional>
#include <type_traits>
#include <variant>

#include <glm/geometric.hpp>

namespace microtrace {

struct ObjectRun;
struct Scene;

/// Support functions. They return the maximum of u . p over a shape's points p, for u of any
/// length.
struct SphereSupport {
  DVec3 center;
  double radius;

  double operator()(const DVec3& u) const {
    return glm::dot(u, center) + radius * std::sqrt(glm::dot(u, u));
  }
};

struct DiscSupport {
  DVec3 center;
  DVec3 normal;  ///< unit vector
  double radius;

  double operator()(const DVec3& u) const {
    // Has the length of u's projection onto the plane.
    const DVec3 in_plane = glm::cross(normal, u);
    return glm::dot(u, center) + radius * std::sqrt(glm::dot(in_plane, in_plane));
  }
};

/// The ellipsoid (p - center)^T A (p - center) = 1 with positive definite A.
struct EllipsoidSupport {
  DVec3 center;
  glm::dmat3 inverse;  ///< inverse of A

  double operator()(const DVec3& u) const {
    return glm::dot(u, center) + std::sqrt(std::fmax(glm::dot(u, inverse * u), 0));
  }
};

/// The quadric as an ellipsoid; nothing if it is not an ellipsoid or is empty.
[[nodiscard]] std::optional<EllipsoidSupport> ellipsoid(const Quadric& quadric);

/// A shape and, if it is a mesh, its placement. Refers to both.
struct PlacedShape {
  const Shape& shape;
  PlacedMesh mesh;  ///< without arrays if the shape is not a mesh

  PlacedShape(const Shape& own)  // NOLINT(google-explicit-constructor)
      : shape(own) {
    if (const auto* arrays = std::get_if<Mesh>(&own)) mesh = *arrays;
  }
  /// The shape of the object with index run.begin + i.
  PlacedShape(const ObjectRun& run, std::size_t i);
};

/// Calls point(DVec3) for points whose convex hull equals that of the shape, or support(f) with the
/// shape's support function f. Calls neither if the shape is empty or unbounded. Ignores vertices
/// that are not finite, and may ignore vertices of placed meshes in boxes for which
/// skips(MeshChunks::Box) is true.
template <class Skips, class Point, class Support>
void visit_extent(const PlacedShape& placed, ChunkedMeshes& chunks, Skips&& skips, Point&& point,
                  Support&& support) {
  const auto visit = [&](const auto& s) {
    using S = std::remove_cvref_t<decltype(s)>;
    if constexpr (std::is_same_v<S, Mesh>) {
      const auto add = [&](const Vec3& p) {
        if (is_finite(p)) point(DVec3(p));
      };
      if (placed.mesh.placement != nullptr) return chunks.of(s).visit(placed.mesh, skips, add);
      for (const Vec3& p : s.positions) add(p);
    } else if constexpr (std::is_same_v<S, Triangle>) {
      for (const Vec3& p : {s.a, s.b, s.c}) {
        if (is_finite(p)) point(DVec3(p));
      }
    } else if constexpr (std::is_same_v<S, Sphere>) {
      if (is_finite(s.center) && s.radius >= 0 && std::isfinite(s.radius))
        support(SphereSupport{.center = s.center, .radius = s.radius});
    } else if constexpr (std::is_same_v<S, Disc>) {
      const bool is_there = is_finite(s.center) && is_finite(s.normal) && s.normal != Vec3(0) &&
                            s.radius >= 0 && std::isfinite(s.radius);
      if (is_there)
        support(DiscSupport{
            .center = s.center, .normal = glm::normalize(DVec3(s.normal)), .radius = s.radius});
    } else if constexpr (std::is_same_v<S, Quadric>) {
      if (const auto f = ellipsoid(s)) support(*f);
    } else {
      static_assert(std::is_same_v<S, Plane>, "has no bounds");
    }
  };
  std::visit(visit, placed.shape);
}

/// The axis-aligned bounding box of a shape; nothing if it is empty or unbounded.
struct Extent {
  DVec3 low, high;
};
[[nodiscard]] std::optional<Extent> extent_of(const PlacedShape& shape, ChunkedMeshes& chunks);

/// Returns true if any object has an extent.
[[nodiscard]] bool has_bounded_object(const Scene& scene);

}  // namespace microtrace
