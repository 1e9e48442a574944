#include "render/lights/area_light.hpp"

#include "render/bsdf/frame.hpp"
#include "render/lights/light_limits.hpp"
#include "render/sampling/warps.hpp"
#include "scene/kernels/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

template <class S>
constexpr bool kIsSampled =
    std::is_same_v<S, Sphere> || std::is_same_v<S, Disc> || std::is_same_v<S, Triangle>;

constexpr double kPi = std::numbers::pi;

/// A planar emitter; `n` is the unit normal of its front.
struct Flat {
  Vec3 n{0, 0, 1};
  double area = 0;
};

/// Makes an emitter with the normal direction v. Its area is 0 if v is zero.
Flat flat(const DVec3& v, double area) {
  const double length = std::sqrt(glm::dot(v, v));
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {.n = Vec3(v / length), .area = area};
}

/// The normal of the triangle's front. Its length is twice the area.
DVec3 area_vector_of(const Triangle& t) {
  return area_vector<1>({DVec3(t.a), DVec3(t.b), DVec3(t.c)});
}

Flat flat_of(const Disc& s) {
  return flat(DVec3(s.normal), kPi * double{s.radius} * double{s.radius});
}
Flat flat_of(const Triangle& s) {
  return flat(area_vector_of(s), triangle_area(s));
}

DVec3 point_of(const Disc& s, const Vec3& n, const Vec2& u) {
  const auto [cosine, sine] = sampling::unit_pair(u.x);
  const float r = std::sqrt(u.y);
  return DVec3(s.center) +
         double{s.radius} * DVec3(bsdf::Frame<1>::about(n).to_world({r * cosine, r * sine, 0}));
}
DVec3 point_of(const Triangle& s, const Vec3&, const Vec2& u) {
  const DVec2 w(sampling::triangle_weights(u));
  return w.x * DVec3(s.a) + w.y * DVec3(s.b) + std::max(1 - w.x - w.y, 0.0) * DVec3(s.c);
}

/// The cone of directions from p to a sphere.
struct Cone {
  Vec3 axis{0, 0, 1};
  double distance = 0;  ///< distance to the center
  double height = 0;    ///< 1 - cos(half angle); 0 if p is inside the sphere

  Cone(const Sphere& s, const Vec3& p) {
    const DVec3 to_light = DVec3(s.center) - DVec3(p);
    const double square = glm::dot(to_light, to_light);
    const double ratio = double{s.radius} * double{s.radius} / square;
    if (!(ratio < 1)) return;
    distance = std::sqrt(square);
    axis = Vec3(to_light / distance);
    height = ratio / (1 + std::sqrt(1 - ratio));
  }
  [[nodiscard]] double pdf() const { return height > 0 ? 1 / (2 * kPi * height) : 0; }
};

LightBounds box(const Vec3& center, const DVec3& reach) {
  return {.low = finite_point(DVec3(center) - reach), .high = finite_point(DVec3(center) + reach)};
}
LightBounds bounds_of(const Disc& s, const Flat& flat) {
  // The half extent of the disc along each axis.
  const Vec3 part = glm::sqrt(glm::max(Vec3(1) - flat.n * flat.n, Vec3(0)));
  return box(s.center, double{s.radius} * DVec3(part));
}
LightBounds bounds_of(const Triangle& s, const Flat&) {
  return {.low = glm::min(s.a, glm::min(s.b, s.c)), .high = glm::max(s.a, glm::max(s.b, s.c))};
}

template <class FlatShape>
LightBounds bounds(const FlatShape& s) {
  const Flat flat = flat_of(s);
  LightBounds result = bounds_of(s, flat);
  result.power = flat.area;
  result.cone.axis = flat.n;
  return result;
}
LightBounds bounds(const Sphere& s) {
  const double r = s.radius;
  LightBounds result = box(s.center, DVec3(r));
  result.power = kPi * r * r;
  result.cone.cos_o = -1;
  return result;
}

template <class FlatShape>
std::optional<ShapeSample> sample(const FlatShape& s, const Vec3& p, const Vec2& u) {
  const Flat flat = flat_of(s);
  const DVec3 to_light = point_of(s, flat.n, u) - DVec3(p);
  const double square = glm::dot(to_light, to_light);
  if (!(square > 0)) return std::nullopt;
  const Vec3 wi(to_light / std::sqrt(square));
  const float cosine = -glm::dot(wi, flat.n);
  if (cosine == 0) return std::nullopt;
  return ShapeSample{.to_light = to_light,
                     .wi = wi,
                     .front = cosine > 0,
                     .pdf = area_pdf<1>(square, flat.area, std::abs(cosine))};
}
std::optional<ShapeSample> sample(const Sphere& s, const Vec3& p, const Vec2& u) {
  const Cone cone(s, p);
  if (cone.height == 0) return std::nullopt;
  const double h = double{u.y} * cone.height, sine = std::sqrt(h * (2 - h));
  const auto [cos_phi, sin_phi] = sampling::unit_pair(u.x);
  const Vec3 local(DVec3(sine * double{cos_phi}, sine * double{sin_phi}, 1 - h));
  const Vec3 wi = bsdf::Frame<1>::about(cone.axis).to_world(local);
  const double off_center = cone.distance * sine, r = s.radius;
  const double half_chord = std::sqrt(std::max(r * r - off_center * off_center, 0.0));
  return ShapeSample{
      .to_light = DVec3(wi) * (cone.distance * (1 - h) - half_chord), .wi = wi, .pdf = cone.pdf()};
}
}  // namespace

std::optional<LightBounds> shape_bounds(const Shape& shape) {
  LightBounds result;
  std::visit(
      [&]<class S>(const S& s) {
        if constexpr (kIsSampled<S>) result = bounds(s);
      },
      shape);
  if (!(result.power > 0) || !std::isfinite(result.power)) return std::nullopt;
  return result;
}

double triangle_area(const Triangle& t) {
  const DVec3 v = area_vector_of(t);
  return std::sqrt(glm::dot(v, v)) / 2;
}

std::optional<ShapeSample> sample_shape(const Shape& shape, const Vec3& p, const Vec2& u) {
  std::optional<ShapeSample> result;
  std::visit(
      [&]<class S>(const S& s) {
        if constexpr (kIsSampled<S>) result = sample(s, p, u);
      },
      shape);
  return result;
}

double shape_pdf(const Shape& shape, const Vec3& p, float distance, float cosine) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return Cone(*sphere, p).pdf();
  Flat flat;
  if (const auto* disc = std::get_if<Disc>(&shape)) flat = flat_of(*disc);
  if (const auto* triangle = std::get_if<Triangle>(&shape)) flat = flat_of(*triangle);
  const double square = double{distance} * double{distance};
  return flat.area > 0 && cosine > 0 ? area_pdf<1>(square, flat.area, cosine) : 0;
}

}  // namespace microtrace
