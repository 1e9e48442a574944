#include "accel/spawn/kernels/kernel.hpp"
#include "accel/spawn/origin_search.hpp"
#include "base/system/float_environment.hpp"

#include <microtrace/spawn.hpp>

namespace microtrace {
namespace {

/// The maximum number of steps off a curved surface, for which there is no proven bound like
/// kFlatSteps.
constexpr int kCurvedSteps = 64;

template <class Surface>
std::optional<Vec3> spawn(Surface surface, const Ray& ray, const Vec3& direction, int most_steps) {
  const FloatEnvironment environment;
  const std::optional<OriginSearch> start = origin_search(surface, ray, direction);
  if (!start) return std::nullopt;
  Vec3 p = start->p;
  for (int step = 0; step <= most_steps && is_finite(p); ++step) {
    if (surface.is_clear(p, direction, start->side)) return p;
    start->step.apply(p);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vec3> spawn_origin(const Triangle& surface, const Ray& ray, const Vec3& direction) {
  return spawn(TriangleSurface(surface), ray, direction, kFlatSteps);
}
std::optional<Vec3> spawn_origin(const Plane& surface, const Ray& ray, const Vec3& direction) {
  return spawn(ExactSurface(surface), ray, direction, kFlatSteps);
}
std::optional<Vec3> spawn_origin(const Disc& surface, const Ray& ray, const Vec3& direction) {
  return spawn(ExactSurface(surface), ray, direction, kFlatSteps);
}
std::optional<Vec3> spawn_origin(const Sphere& surface, const Ray& ray, const Vec3& direction) {
  return spawn(ExactSurface(surface), ray, direction, kCurvedSteps);
}
std::optional<Vec3> spawn_origin(const Quadric& surface, const Ray& ray, const Vec3& direction) {
  return spawn(ExactSurface(surface), ray, direction, kCurvedSteps);
}

std::optional<Vec3> spawn_origin(const Primitives& primitives, PrimitiveId id, const Ray& ray,
                                 const Vec3& direction) {
  const FloatEnvironment environment;
  return primitives.visit(id,
                          [&](const auto& shape) { return spawn_origin(shape, ray, direction); });
}

}  // namespace microtrace
