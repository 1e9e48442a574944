#include "accel/exact_hits.hpp"

#include "exact/intersect.hpp"
#include "exact/triangle_hit.hpp"

namespace microtrace {
namespace {

/// Nothing if it is of another shape.
std::optional<Triangle> triangle(const Primitives& primitives, PrimitiveId id) {
  return primitives.visit(id, [](const auto& shape) -> std::optional<Triangle> {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>)
      return shape;
    else
      return std::nullopt;
  });
}

/// Whether two triangles lie in one plane x_k = s that the ray crosses. Then it meets both at t =
/// (s
/// - o_k) / d_k, if it does: so it is with boxes that stand on floors or side by side.
bool share_axis_plane(const Triangle& a, const Triangle& b, const Vec3& d) {
  for (int k = 0; k < 3; ++k) {
    const float s = a.a[k];
    if (d[k] != 0 && a.b[k] == s && a.c[k] == s && b.a[k] == s && b.b[k] == s && b.c[k] == s)
      return true;
  }
  return false;
}

}  // namespace

std::optional<exact::Root> ExactHits::root(PrimitiveId id) const {
  return primitives_->visit(id, [&](const auto& shape) { return exact::first_hit(shape, *ray_); });
}

std::optional<exact::Enclosure> ExactHits::bounds(PrimitiveId id) const {
  if (const auto t = triangle(*primitives_, id)) {
    exact::TriangleHit hit(*t, *ray_);
    return hit.exists() ? std::optional(hit.bounds()) : std::nullopt;
  }
  const std::optional<exact::Root> t = root(id);
  return t ? std::optional(exact::enclose(*t)) : std::nullopt;
}

std::strong_ordering ExactHits::order(PrimitiveId id, PrimitiveId other) const {
  const auto a = triangle(*primitives_, id), b = triangle(*primitives_, other);
  if (!a || !b) return *root(id) <=> *root(other);
  if (share_axis_plane(*a, *b, ray_->d)) return std::strong_ordering::equal;
  return exact::TriangleHit(*a, *ray_).order(*b);
}

float ExactHits::t(PrimitiveId id) const {
  if (const auto t = triangle(*primitives_, id)) return exact::TriangleHit(*t, *ray_).t();
  return exact::round_to_float(*root(id));
}

}  // namespace microtrace
