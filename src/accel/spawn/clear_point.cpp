#include "accel/spawn/clear_point.hpp"

#include "accel/build/references/shape_box.hpp"
#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/touching.hpp"
#include "exact/triangle_box.hpp"

#include <algorithm>

namespace microtrace {
namespace {

// Returns true if the bounding boxes exclude a common point. Makes the result for shapes other than
// triangles independent of the tree, which decides what primitives are near enough to be tested.
template <class AnyShape>
bool is_apart(const AnyShape& shape, const Bounds& box) {
  const build::Box own = build::box_of(shape);
  return !overlap(
      {.lo = {own.lo[0], own.lo[1], own.lo[2]}, .hi = {own.hi[0], own.hi[1], own.hi[2]}}, box);
}
bool is_apart(const Plane&, const Bounds&) {
  return false;
}

// Decides what clears_box leaves open. Exactly for triangles, because the tree may have split them:
// whether it finds the triangle then depends on the boxes of its parts, if the triangle is near the
// box but does not meet it.
bool meets(const Triangle& triangle, const Bounds& box) {
  return exact::meets_box(triangle, box.lo, box.hi);
}
template <class Other>
bool meets(const Other&, const Bounds&) {
  return true;
}

}  // namespace

bool is_clear_among(const Primitives& primitives, const Tree* tree,
                    std::span<const PrimitiveId> unbounded, const Vec3& p) {
  if (!is_filterable(p)) return false;
  const DVec3 middle(p), radius(spacing(p.x), spacing(p.y), spacing(p.z));
  const Bounds box{.lo = Vec3(middle - radius), .hi = Vec3(middle + radius)};  // exact in float32
  bool is_clear = true;
  const auto test = [&](PrimitiveId id) {
    is_clear = is_clear && primitives.visit(id, [&](const auto& shape) {
      return build::is_empty(shape) || is_apart(shape, box) ||
             (is_filterable(shape) && clears_box(shape, middle, radius)) || !meets(shape, box);
    });
  };
  std::ranges::for_each(unbounded, test);
  if (tree != nullptr) for_each_touching(*tree, box, test);
  return is_clear;
}

}  // namespace microtrace
