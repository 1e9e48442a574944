#include "render/prepared/recentered.hpp"

#include "scene/mesh/shared_meshes.hpp"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <unordered_map>
#include <variant>

namespace microtrace {
namespace {

/// Calls f(point) for each point that defines the shape's position. Returns true if these points
/// define the position completely.
template <class AnyShape, class F>
bool for_each_point(AnyShape& shape, const F& f) {
  using Kind = std::remove_const_t<AnyShape>;
  if constexpr (std::is_same_v<Kind, Mesh>) {
    if constexpr (std::is_const_v<AnyShape>) {
      for (std::size_t i = 0; i < shape.positions.size(); ++i) f(shape.position(i));
    } else {
      if (shape.placement) shape = baked(shape);
      for (Vec3& p : shape.positions.edit()) f(p);
    }
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

std::optional<PointBounds> bounds_of_points(const Scene& scene) {
  PointBounds bounds;
  const auto add = [&](const Vec3& p) { bounds.add(DVec3(p)); };
  std::unordered_map<ArrayKey, PointBounds, ArrayKey::Hash> boxes;  // by positions of shared meshes
  for (const ObjectRun& run : scene.objects.runs()) {
    const PlacedMesh first = run.mesh(0);
    if (first.placement == nullptr) {
      const bool is_defined = std::visit(
          [&](const auto& shape) { return for_each_point(shape, add); }, run.first->shape);
      if (!is_defined) return std::nullopt;
      continue;
    }
    // There may be millions of instances, so the box of an instance is that of its mesh's corners.
    const Array<Vec3>& positions = first.arrays->positions;
    const auto [box, is_new] = boxes.try_emplace(ArrayKey(positions));
    if (is_new)
      for (const Vec3& p : positions) box->second.add(DVec3(p));
    if (positions.empty()) continue;
    for (const DVec3& corner : corners_of(box->second))
      for (std::size_t i = 0; i < run.count; ++i) bounds.add(run.mesh(i).placement->point(corner));
  }
  return bounds;
}

DVec3 translation_to_origin(const PointBounds& points, const Camera& camera) {
  PointBounds bounds = points;
  std::visit([&](const auto& c) { bounds.add(c.pose.position); }, camera);
  if (bounds.low == bounds.high) return DVec3(0);  // all is at the camera
  return translation_to_origin(bounds);
}

std::optional<Scene> moved(const Scene& scene, const DVec3& by) {
  Scene result = scene;
  result.origin -= by;
  bool is_exact = true;
  for_each_point_of_shapes(result, [&](Vec3& p) {
    const Vec3 there(DVec3(p) + by);
    is_exact &= DVec3(there) - by == DVec3(p);
    p = there;
  });
  if (!is_exact) return std::nullopt;
  for (NamedLight& light : result.lights) {
    std::visit(
        [&](auto& l) {
          if constexpr (requires { l.position; }) l.position += by;
        },
        light.light);
  }
  return result;
}

Camera moved(const Camera& camera, const DVec3& by) {
  Camera result = camera;
  std::visit([&](auto& c) { c.pose.position += by; }, result);
  return result;
}

}  // namespace microtrace
