#include "accel/spawn/shape_spawn.hpp"

#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/origin_search.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The maximum number of steps by which an origin is moved off a sphere. spawn_among takes the same
/// number of steps before it tries points farther along the ray.
constexpr int kBallSteps = 8;

bool is_filterable(const Ray& ray) {
  return microtrace::is_filterable(ray.o) && microtrace::is_filterable(ray.d);
}

}  // namespace

ShapeSpawn::ShapeSpawn(const Plane& s, const Ray& ray) {
  if (microtrace::is_filterable(s)) {
    set_flat({.a = s.point, .normal = CrossProduct(DVec3(s.normal))}, ray);
  }
}
ShapeSpawn::ShapeSpawn(const Disc& s, const Ray& ray) {
  if (microtrace::is_filterable(s)) {
    set_flat({.a = s.center, .normal = CrossProduct(DVec3(s.normal))}, ray);
  }
}
ShapeSpawn::ShapeSpawn(const Quadric&, const Ray&) {}

ShapeSpawn::ShapeSpawn(const Sphere& s, const Ray& ray) {
  if (!microtrace::is_filterable(s) || !is_filterable(ray)) return;
  const FilterResult t =
      seen_from(ray.o, s)(DVec3(ray.d), {.t_min = ray.t_min, .t_max = ray.t_max});
  if (t.certainty != Certainty::hit) return;
  const PointOnRay x(ray, {t.lo, t.hi});
  p_ = rounded_point(x);
  if (!p_) return;
  // The difference has one rounding, so half of gamma(2) would suffice.
  surface_ = Ball{.sphere = s,
                  .from_center = x.value - DVec3(s.center),
                  .error = x.error + gamma(2) * glm::abs(x.value - DVec3(s.center))};
  double largest = 0, second = 0;
  for (int k = 0; k < 3; ++k) {
    const double unit = spacing((*p_)[k]);
    const double gain = std::abs(double{(*p_)[k]} - s.center[k]) * unit;
    second = std::max(second, std::min(gain, largest));
    if (gain > largest) axis_ = k, largest = gain;
  }
  // If the two largest gains are nearly equal, exact arithmetic must choose the axis. A gain has
  // one rounding, whose relative error is far below 2^-31.
  if (!(largest > second * (1 + 0x1p-30)))
    p_.reset();
  else
    set_reach(kBallSteps);
}

void ShapeSpawn::set_reach(int steps) {
  for (int k = 0; k < 3; ++k) {
    const double unit = spacing((*p_)[k]);
    reach_[k] = k == axis_ ? reach_of(steps, unit) : unit / 2;
  }
}

void ShapeSpawn::set_flat(const Flat& flat, const Ray& ray) {
  if (!is_filterable(ray)) return;
  const DVec3 from_a = DVec3(flat.a) - DVec3(ray.o);
  // As in TrianglePlaneFilter. The normal is exact, so half of this bound would suffice.
  const Approximate height{
      .value = glm::dot(from_a, flat.normal.value),
      .error = gamma(9) * glm::dot(glm::abs(from_a), flat.normal.permanent) + kUnderflow};
  const FilterResult t = result_of(quotient_result(height, flat.normal.along(DVec3(ray.d)),
                                                   {.t_min = ray.t_min, .t_max = ray.t_max}));
  if (t.certainty == Certainty::unsure) return;
  p_ = rounded_point({ray, {t.lo, t.hi}}, flat.a, flat.normal);
  if (!p_) return;
  surface_ = flat;
  double largest = 0, error = 0;
  for (int k = 0; k < 3; ++k) {
    const double unit = spacing((*p_)[k]), gain = std::abs(flat.normal.value[k]) * unit;
    error += gamma(5) * flat.normal.permanent[k] * unit;
    if (gain > largest) axis_ = k, largest = gain;
  }
  // If the error is larger, exact arithmetic must choose the axis, as in TriangleSurface::gradient.
  // Half of gamma(5) would suffice, as explained there.
  if (!(error <= 0x1p-9 * largest))
    p_.reset();
  else
    set_reach(kFlatSteps);
}

std::optional<AxisPlane> ShapeSpawn::axis_plane() const {
  const auto* flat = std::get_if<Flat>(&surface_);
  return flat == nullptr ? std::nullopt : AxisPlane::of(flat->a, flat->normal.permanent);
}

std::optional<Vec3> ShapeSpawn::origin(const Vec3& direction) const {
  if (!microtrace::is_filterable(direction)) return std::nullopt;
  if (const auto* flat = std::get_if<Flat>(&surface_)) return origin(*flat, direction);
  if (const auto* ball = std::get_if<Ball>(&surface_)) return origin(*ball, direction);
  return std::nullopt;
}

std::optional<Vec3> ShapeSpawn::origin(const Flat& flat, const Vec3& direction) const {
  const Approximate slope = flat.normal.along(DVec3(direction));
  if (!slope.is_positive() && !slope.is_negative()) return std::nullopt;
  const int side = slope.is_positive() ? 1 : -1;
  const bool up = (flat.normal.value[axis_] > 0) == (side > 0);
  Vec3 q = *p_;
  for (int step = 0; step <= kFlatSteps; ++step) {
    const int sign = certain_side(flat.a, flat.normal, DVec3(q), DVec3(0));
    if (sign == side) return q;
    // If all terms are zero, q is exactly on the plane, which is common on floors and walls.
    const DVec3 from_a = DVec3(q) - DVec3(flat.a);
    const bool is_on = glm::dot(glm::abs(from_a), flat.normal.permanent) == 0;
    if (sign == 0 && !is_on) return std::nullopt;
    q[axis_] = neighbor(q[axis_], up);
  }
  return std::nullopt;
}

std::optional<Vec3> ShapeSpawn::origin(const Ball& ball, const Vec3& direction) const {
  const DVec3 w(direction), size = glm::abs(w);
  // The product and the sums have three roundings, so half of gamma(6) would suffice.
  const Approximate slope{.value = glm::dot(ball.from_center, w),
                          .error = gamma(6) * glm::dot(glm::abs(ball.from_center), size) +
                                   glm::dot(ball.error, size) + kUnderflow};
  if (!slope.is_positive() && !slope.is_negative()) return std::nullopt;
  const int side = slope.is_positive() ? 1 : -1;
  const DVec3 center(ball.sphere.center);
  const bool up = ((*p_)[axis_] > center[axis_]) == (side > 0);
  Vec3 q = *p_;
  for (int step = 0; step <= kBallSteps; ++step) {
    const Approximate f = ball_value(ball.sphere.center, ball.sphere.radius, DVec3(q), DVec3(0));
    if (!f.is_positive() && !f.is_negative()) return std::nullopt;
    if (f.is_positive() == (side > 0)) {
      // A ray that starts inside leaves the sphere exactly once. A ray that starts outside must not
      // enter the sphere.
      if (side < 0 || dot_product(DVec3(q) - center, w, 4).is_positive()) return q;
      return std::nullopt;
    }
    q[axis_] = neighbor(q[axis_], up);
  }
  return std::nullopt;
}

}  // namespace microtrace
