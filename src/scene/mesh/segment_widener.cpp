#include "scene/mesh/segment_widener.hpp"

#include "scene/support.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace microtrace {
namespace {

/// Half the width of a line and half the side of a point, in pixels. The width is slightly more
/// than 1, so that rounding leaves no gap. The bias moves lines right and down, so that of two rows
/// of pixels at the same distance only one is covered.
constexpr double kHalfWidth = 0.5 + 1.0 / 64;
constexpr double kBias = 1.0 / 32;
/// Lines are clipped this many pixels outside the picture.
constexpr double kMargin = 2;

/// The part [start, end] of a segment, clipped by half-spaces (Liang and Barsky 1984).
struct Part {
  double start = 0, end = 1;

  /// Keeps the part where a linear function, which is f at the segment's start and g at its end, is
  /// nonnegative. Returns false if nothing is left.
  bool keep(double f, double g) {
    if (f < 0 && g < 0) return false;
    if (f < 0) start = std::max(start, f / (f - g));
    if (g < 0) end = std::min(end, f / (f - g));
    return start <= end;
  }
};

}  // namespace

SegmentWidener::SegmentWidener(const Camera& camera, ImageSize size) : rays_(camera, size) {}

std::optional<WideSegment> SegmentWidener::operator()(const Vec3& a, const Vec3& b) const {
  if (!is_finite(a) || !is_finite(b)) return std::nullopt;
  const bool environment = rays_.kind_ == RayGenerator::Kind::environment;
  return environment ? spherical(DVec3(a), DVec3(b)) : planar(DVec3(a), DVec3(b));
}

SegmentWidener::Projected SegmentWidener::project(const DVec3& p) const {
  const DVec3 v = p - rays_.position_;
  const double depth = glm::dot(v, rays_.forward_);
  const double w = rays_.kind_ == RayGenerator::Kind::perspective ? depth : 1;
  const auto along = [&v](const DVec3& step) { return glm::dot(v, step) / glm::dot(step, step); };
  return {.x = along(rays_.right_) + w * (rays_.size_.width / 2.0),
          .y = along(rays_.down_) + w * (rays_.size_.height / 2.0),
          .w = w,
          .depth = depth};
}

std::optional<WideSegment> SegmentWidener::planar(const DVec3& a, const DVec3& b) const {
  const Projected f = project(a), g = project(b);
  const double right = rays_.size_.width + kMargin, bottom = rays_.size_.height + kMargin;
  Part part;
  const bool seen = part.keep(f.depth - rays_.depth_.near, g.depth - rays_.depth_.near) &&
                    part.keep(f.x + kMargin * f.w, g.x + kMargin * g.w) &&
                    part.keep(right * f.w - f.x, right * g.w - g.x) &&
                    part.keep(f.y + kMargin * f.w, g.y + kMargin * g.w) &&
                    part.keep(bottom * f.w - f.y, bottom * g.w - g.y);
  if (!seen) return std::nullopt;

  struct End {
    DVec3 p;
    double w;
    glm::dvec2 pixel;
  };
  const auto at = [&](double t) {
    const double w = f.w + (g.w - f.w) * t;
    return End{.p = a + (b - a) * t,
               .w = w,
               .pixel = glm::dvec2(f.x + (g.x - f.x) * t, f.y + (g.y - f.y) * t) / w};
  };
  End start = at(part.start), end = at(part.end);
  const glm::dvec2 way = end.pixel - start.pixel;
  const double extent = std::max(std::abs(way.x), std::abs(way.y));
  glm::dvec2 along(1, 0);
  if (extent >= 1) {
    along = way / std::sqrt(glm::dot(way, way));
  } else {
    part.start = part.end = (part.start + part.end) / 2;
    start = end = at(part.start);
  }
  if (!(start.w > 0 && end.w > 0)) return std::nullopt;  // at the camera's position

  const glm::dvec2 cap = along * kHalfWidth;
  const glm::dvec2 side(cap.y, -cap.x);  // to the left of the segment
  const auto corner = [&](const End& from, const glm::dvec2& pixels) {
    return Vec3(from.p +
                (rays_.right_ * (pixels.x + kBias) + rays_.down_ * (pixels.y + kBias)) * from.w);
  };
  return WideSegment{.corners = {corner(start, side - cap), corner(start, -side - cap),
                                 corner(end, cap - side), corner(end, cap + side)},
                     .start = part.start,
                     .end = part.end};
}

std::optional<WideSegment> SegmentWidener::spherical(const DVec3& a, const DVec3& b) const {
  // The angle of a pixel at the equator; nearer to the poles it spans more pixels horizontally.
  const double pixel =
      std::max(std::numbers::pi / rays_.size_.height, 2 * std::numbers::pi / rays_.size_.width);
  DVec3 v = a - rays_.position_, w = b - rays_.position_;
  const DVec3 normal = glm::cross(w, v);
  const double area = std::sqrt(glm::dot(normal, normal));
  double start = 0, end = 1;
  DVec3 side, along;
  if (area > pixel * std::sqrt(glm::dot(v, v) * glm::dot(w, w)) ||
      (glm::dot(v, w) < 0 && area > 0)) {
    side = normal / area;
    along = glm::normalize(w - v);
  } else {
    start = end = 0.5;
    v = w = (v + w) * 0.5;
    const DVec3 across = glm::cross(v, -rays_.down_);
    const bool at_pole = glm::dot(across, across) <= 1e-12 * glm::dot(v, v);
    along = at_pole ? rays_.right_ : glm::normalize(across);
    side = glm::cross(along, v);
    side /= std::sqrt(glm::dot(side, side));
  }
  const auto corner = [&](const DVec3& from, double sideward, double onward) {
    const double half = kHalfWidth * pixel * std::sqrt(glm::dot(from, from));
    return Vec3(rays_.position_ + from + side * (sideward * half) + along * (onward * half));
  };
  return WideSegment{
      .corners = {corner(v, 1, -1), corner(v, -1, -1), corner(w, -1, 1), corner(w, 1, 1)},
      .start = start,
      .end = end};
}

}  // namespace microtrace
