#include "render/lights/shape_light.hpp"

#include "render/bsdf/frame.hpp"
#include "render/sampling/warps.hpp"

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

constexpr auto kPi = static_cast<float>(std::numbers::pi);

/// A part of a plane; `n` is the unit normal of its front.
struct Flat {
  Vec3 n{0, 0, 1};
  float area = 0;
};

/// Without area where v has no direction.
Flat flat(const DVec3& v, double area) {
  const double length = std::sqrt(glm::dot(v, v));
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {.n = Vec3(v / length), .area = static_cast<float>(area)};
}
Flat flat_of(const Disc& s) {
  return flat(DVec3(s.normal), std::numbers::pi * double{s.radius} * double{s.radius});
}
Flat flat_of(const Triangle& s) {
  const DVec3 v = glm::cross(DVec3(s.b) - DVec3(s.a), DVec3(s.c) - DVec3(s.a));
  return flat(v, std::sqrt(glm::dot(v, v)) / 2);
}

Vec3 point_of(const Disc& s, const Vec3& n, const Vec2& u) {
  const auto [cosine, sine] = sampling::unit_pair(u.x);
  const float r = s.radius * std::sqrt(u.y);
  return s.center + bsdf::Frame::about(n).to_world({r * cosine, r * sine, 0});
}
Vec3 point_of(const Triangle& s, const Vec3&, const Vec2& u) {
  const Vec2 w = sampling::triangle_weights(u);
  return w.x * s.a + w.y * s.b + std::max(1 - w.x - w.y, 0.0F) * s.c;
}

float density_of(const Flat& flat, float square, float cosine) {
  return square / (flat.area * cosine);
}

/// What p sees of a sphere: directions within an angle of the way to its centre.
struct Cone {
  Vec3 axis{0, 0, 1};
  float distance = 0;  ///< of the centre
  float height = 0;    ///< 1 - cos(angle); 0: p is not outside

  Cone(const Sphere& s, const Vec3& p) {
    const Vec3 way = s.center - p;
    const float square = glm::dot(way, way), ratio = s.radius * s.radius / square;
    if (!(ratio < 1)) return;
    distance = std::sqrt(square);
    axis = way / distance;
    height = ratio / (1 + std::sqrt(1 - ratio));
  }
  [[nodiscard]] float density() const { return height > 0 ? 1 / (2 * kPi * height) : 0; }
};

LightBounds bounds_of(const Disc& s, const Flat& flat) {
  // Along each axis as far as the disc's edge goes.
  const Vec3 reach = s.radius * glm::sqrt(glm::max(Vec3(1) - flat.n * flat.n, Vec3(0)));
  return {.low = s.center - reach, .high = s.center + reach};
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
  return {.low = s.center - s.radius,
          .high = s.center + s.radius,
          .power = kPi * s.radius * s.radius,
          .cone = {.cos_o = -1}};
}

template <class FlatShape>
std::optional<ShapeSample> sample(const FlatShape& s, const Vec3& p, const Vec2& u) {
  const Flat flat = flat_of(s);
  const Vec3 way = point_of(s, flat.n, u) - p;
  const float square = glm::dot(way, way);
  if (!(square > 0)) return std::nullopt;
  const Vec3 wi = way / std::sqrt(square);
  const float cosine = -glm::dot(wi, flat.n);
  if (cosine == 0) return std::nullopt;
  return ShapeSample{.way = way,
                     .wi = wi,
                     .front = cosine > 0,
                     .density = density_of(flat, square, std::abs(cosine))};
}
std::optional<ShapeSample> sample(const Sphere& s, const Vec3& p, const Vec2& u) {
  const Cone cone(s, p);
  if (cone.height == 0) return std::nullopt;
  const float h = u.y * cone.height, sine = std::sqrt(h * (2 - h));
  const auto [cos_phi, sin_phi] = sampling::unit_pair(u.x);
  const Vec3 wi = bsdf::Frame::about(cone.axis).to_world({sine * cos_phi, sine * sin_phi, 1 - h});
  const float off_centre = cone.distance * sine;
  const float half_chord = std::sqrt(std::max(s.radius * s.radius - off_centre * off_centre, 0.0F));
  return ShapeSample{
      .way = wi * (cone.distance * (1 - h) - half_chord), .wi = wi, .density = cone.density()};
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

std::optional<ShapeSample> sample_shape(const Shape& shape, const Vec3& p, const Vec2& u) {
  std::optional<ShapeSample> result;
  std::visit(
      [&]<class S>(const S& s) {
        if constexpr (kIsSampled<S>) result = sample(s, p, u);
      },
      shape);
  return result;
}

float shape_density(const Shape& shape, const Vec3& p, float distance, float cosine) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return Cone(*sphere, p).density();
  Flat flat;
  if (const auto* disc = std::get_if<Disc>(&shape)) flat = flat_of(*disc);
  if (const auto* triangle = std::get_if<Triangle>(&shape)) flat = flat_of(*triangle);
  return flat.area > 0 && cosine > 0 ? density_of(flat, distance * distance, cosine) : 0;
}

}  // namespace microtrace
