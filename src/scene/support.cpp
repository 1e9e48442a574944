#include "scene/support.hpp"

#include <microtrace/scene.hpp>

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

namespace microtrace {

// With A c = -b, the equation p^T A p + 2 b . p + j = 0 becomes (p - c)^T A (p - c) = c^T A c - j.
std::optional<EllipsoidSupport> ellipsoid(const Quadric& q) {
  const double sign = q.a < 0 ? -1 : 1;
  const double a = sign * q.a, b = sign * q.b, c = sign * q.c;
  const double d = sign * q.d / 2, e = sign * q.e / 2, f = sign * q.f / 2;
  const glm::dmat3 matrix(a, d, e, d, b, f, e, f, c);
  const bool positive_definite = a > 0 && a * b - d * d > 0 && glm::determinant(matrix) > 0;
  if (!positive_definite) return std::nullopt;
  const DVec3 half_linear = DVec3(q.g, q.h, q.i) * (sign / 2);
  const glm::dmat3 inverse = glm::inverse(matrix);
  const DVec3 center = -(inverse * half_linear);
  const double square = -glm::dot(half_linear, center) - sign * q.j;
  if (!(square >= 0) || !std::isfinite(square)) return std::nullopt;
  return EllipsoidSupport{.center = center, .inverse = inverse * square};
}

PlacedShape::PlacedShape(const ObjectRun& run, std::size_t i)
    : shape(run.first->shape), mesh(run.mesh(i)) {}

std::optional<Extent> extent_of(const PlacedShape& shape, ChunkedMeshes& chunks) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent extent{.low = DVec3(kInfinity), .high = DVec3(-kInfinity)};
  visit_extent(
      shape, chunks,
      [&](const MeshChunks::Box& box) {
        return glm::all(glm::lessThanEqual(extent.low, DVec3(box.lo))) &&
               glm::all(glm::lessThanEqual(DVec3(box.hi), extent.high));
      },
      [&](const DVec3& p) {
        extent.low = glm::min(extent.low, p);
        extent.high = glm::max(extent.high, p);
      },
      [&](const auto& support) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
          DVec3 unit(0);
          unit[axis] = 1;
          extent.high[axis] = support(unit);
          extent.low[axis] = -support(-unit);
        }
      });
  if (!(extent.low.x <= extent.high.x)) return std::nullopt;
  return extent;
}

bool has_bounded_object(const Scene& scene) {
  ChunkedMeshes chunks;
  for (const ObjectRun& run : scene.objects.runs())
    for (std::size_t i = 0; i < run.count; ++i)
      if (extent_of({run, i}, chunks)) return true;
  return false;
}

}  // namespace microtrace
