#include "accel/resolve/exact_hits.hpp"

#include "exact/first_hit.hpp"
#include "exact/triangle_hit.hpp"

namespace microtrace {
namespace {

/// True if two triangles lie in the same axis-aligned plane x_k = s and the ray is not parallel to
/// the plane. If the ray hits both triangles, both hits then have the parameter (s - o_k) / d_k.
/// Such triangles are common, for example where a box stands on a floor.
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
  if (const auto t = primitives_->triangle(id)) {
    exact::TriangleHit hit(*t, *ray_);
    return hit.exists() ? std::optional(hit.bounds()) : std::nullopt;
  }
  const std::optional<exact::Root> t = root(id);
  return t ? std::optional(exact::enclose(*t)) : std::nullopt;
}

std::strong_ordering ExactHits::order(PrimitiveId id, PrimitiveId other) const {
  const auto a = primitives_->triangle(id), b = primitives_->triangle(other);
  if (!a || !b) return *root(id) <=> *root(other);
  if (share_axis_plane(*a, *b, ray_->d)) return std::strong_ordering::equal;
  return exact::TriangleHit(*a, *ray_).order(*b);
}

float ExactHits::t(PrimitiveId id) const {
  if (const auto t = primitives_->triangle(id)) return exact::TriangleHit(*t, *ray_).t();
  return exact::round_to_float(*root(id));
}

}  // namespace microtrace
