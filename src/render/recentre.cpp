#include "render/recentre.hpp"

#include "base/memory_account.hpp"
#include "scene/mesh_memory.hpp"
#include "scene/translation_to_origin.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

namespace microtrace {
namespace {

/// f(point) for each point by which the shape's place is given, of whatever constness; whether
/// those are all that the place is given by.
template <class AnyShape, class F>
bool for_each_point(AnyShape& shape, const F& f) {
  using Kind = std::remove_const_t<AnyShape>;
  if constexpr (std::is_same_v<Kind, Mesh>) {
    for (auto& p : shape.positions) f(p);
  } else if constexpr (std::is_same_v<Kind, Triangle>) {
    f(shape.a);
    f(shape.b);
    f(shape.c);
  } else if constexpr (std::is_same_v<Kind, Plane>) {
    f(shape.point);
  } else if constexpr (std::is_same_v<Kind, Quadric>) {
    return false;
  } else {
    f(shape.center);
  }
  return true;
}

template <class AnyScene, class F>
bool for_each_point_of_shapes(AnyScene& scene, const F& f) {
  return std::ranges::all_of(scene.objects, [&](auto& object) {
    return std::visit([&](auto& shape) { return for_each_point(shape, f); }, object.shape);
  });
}

}  // namespace

std::optional<PlacedScene> recentred(const Scene& scene, const Camera& camera) {
  PointBounds bounds;
  std::visit([&](const auto& c) { bounds.add(c.pose.position); }, camera);
  if (!for_each_point_of_shapes(scene, [&](const Vec3& p) { bounds.add(DVec3(p)); }))
    return std::nullopt;
  const DVec3 way = translation_to_origin(bounds);
  if (way == DVec3(0)) return std::nullopt;

  take_memory(memory_of(scene), "the scene next to the origin");
  PlacedScene moved{.scene = scene, .camera = camera};
  bool is_exact = true;
  for_each_point_of_shapes(moved.scene, [&](Vec3& p) {
    const Vec3 there(DVec3(p) + way);
    is_exact &= DVec3(there) - way == DVec3(p);
    p = there;
  });
  if (!is_exact) return std::nullopt;
  std::visit([&](auto& c) { c.pose.position += way; }, moved.camera);
  for (NamedLight& light : moved.scene.lights) {
    std::visit(
        [&](auto& l) {
          if constexpr (requires { l.position; }) l.position += way;
        },
        light.light);
  }
  return moved;
}

}  // namespace microtrace
