#include "scene/mesh/segment_widener.hpp"

#include "scene/lens/lens.hpp"
#include "scene/support.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace microtrace {
namespace {

/// Half the width of a line and half the side of a point, in pixels. The width is slightly more
/// than 1 pixel, which closes gaps due to rounding. The bias moves lines right and down, so that a
/// line midway between two rows of pixels covers only one of them.
constexpr double kHalfWidth = 0.5 + 1.0 / 64;
constexpr double kBias = 1.0 / 32;
/// Lines are clipped to the picture enlarged by this many pixels on each side.
constexpr double kMargin = 2;

/// The part [start, end] of a segment, clipped by half-spaces (Liang and Barsky 1984).
struct Part {
  double start = 0, end = 1;

  /// Keeps the part where a linear function is nonnegative. Its values at the segment's start and
  /// end are f and g. Returns false if nothing is left.
  bool keep(double f, double g) {
    if (f < 0 && g < 0) return false;
    if (f < 0) start = std::max(start, f / (f - g));
    if (g < 0) end = std::min(end, f / (f - g));
    return start <= end;
  }
};

}  // namespace

SegmentWidener::SegmentWidener(const Camera& camera, ImageSize size)
    : rays_(camera, size),
      is_planar_(rays_.kind_ == RayGenerator::Kind::perspective ||
                 rays_.kind_ == RayGenerator::Kind::orthographic),
      right_(rays_.right_),
      down_(rays_.down_),
      low_(-kMargin),
      high_(size.width + kMargin, size.height + kMargin),
      // The angle of a pixel at the equator. Closer to the poles, this angle spans more pixels.
      angle_(std::max(std::numbers::pi / size.height, 2 * std::numbers::pi / size.width)) {
  if (rays_.kind_ == RayGenerator::Kind::distorted) allow_for_lens();
}

/// Sets the width of lines to that of the pixel that covers the largest range of directions, so
/// that no line is thinner than a pixel.
void SegmentWidener::allow_for_lens() {
  constexpr int kSamples = 32;  // on each side of the picture
  // Limit, because the stretch is infinite at the edge of the invertible range.
  constexpr double kMaxStretch = 4;
  const DVec2 focal = rays_.pixels_per_unit_, size(rays_.size_.width, rays_.size_.height);
  is_planar_ = std::holds_alternative<RationalDistortion>(*rays_.distortion_);
  right_ /= focal.x;
  down_ /= focal.y;
  DVec2 low(0), high(0);  // bounds of the directions at depth 1
  for (int y = 0; y <= kSamples; ++y) {
    for (int x = 0; x <= kSamples; ++x) {
      const DVec2 pixel = size * DVec2(x, y) / double{kSamples};
      const auto direction = rays_.lens_->direction((pixel - rays_.center_) / focal);
      if (!direction) continue;
      const DVec3 d = *direction / std::sqrt(glm::dot(*direction, *direction));
      const LensDifferential step = rays_.lens_->differential(d);
      const auto stretch = [&](const DVec3& v) {
        const DVec2 across = (DVec2(v) - DVec2(d) * (v.z / d.z)) / d.z;  // at depth 1
        return std::sqrt(is_planar_ ? glm::dot(across, across) : glm::dot(v, v));
      };
      width_ = std::clamp(std::max(stretch(step.dx), stretch(step.dy)), width_, kMaxStretch);
      if (is_planar_) {
        low = glm::min(low, DVec2(*direction));
        high = glm::max(high, DVec2(*direction));
      }
    }
  }
  // Twice the bounds of the samples, to contain everything between samples.
  low_ = rays_.center_ + 2.0 * low * focal - kMargin;
  high_ = rays_.center_ + 2.0 * high * focal + kMargin;
  angle_ = width_ / std::min(focal.x, focal.y);
}

std::optional<WideSegment> SegmentWidener::operator()(const Vec3& a, const Vec3& b) const {
  if (!is_finite(a) || !is_finite(b)) return std::nullopt;
  return is_planar_ ? planar(DVec3(a), DVec3(b)) : spherical(DVec3(a), DVec3(b));
}

SegmentWidener::Projected SegmentWidener::project(const DVec3& p) const {
  const DVec3 v = p - rays_.position_;
  const double depth = glm::dot(v, rays_.forward_);
  const double w = rays_.kind_ == RayGenerator::Kind::orthographic ? 1 : depth;
  const auto along = [&v](const DVec3& step) { return glm::dot(v, step) / glm::dot(step, step); };
  return {.x = along(right_) + w * rays_.center_.x,
          .y = along(down_) + w * rays_.center_.y,
          .w = w,
          .depth = depth};
}

std::optional<WideSegment> SegmentWidener::planar(const DVec3& a, const DVec3& b) const {
  const Projected f = project(a), g = project(b);
  Part part;
  const bool seen = part.keep(f.depth - rays_.depth_.near, g.depth - rays_.depth_.near) &&
                    part.keep(f.x - low_.x * f.w, g.x - low_.x * g.w) &&
                    part.keep(high_.x * f.w - f.x, high_.x * g.w - g.x) &&
                    part.keep(f.y - low_.y * f.w, g.y - low_.y * g.w) &&
                    part.keep(high_.y * f.w - f.y, high_.y * g.w - g.y);
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
  if (!(start.w > 0 && end.w > 0)) return std::nullopt;  // an end is at the camera's position

  const glm::dvec2 cap = along * (kHalfWidth * width_);
  const glm::dvec2 side(cap.y, -cap.x);  // to the left of the segment
  const auto corner = [&](const End& from, const glm::dvec2& pixels) {
    return Vec3(from.p + (right_ * (pixels.x + kBias) + down_ * (pixels.y + kBias)) * from.w);
  };
  return WideSegment{.corners = {corner(start, side - cap), corner(start, -side - cap),
                                 corner(end, cap - side), corner(end, cap + side)},
                     .start = part.start,
                     .end = part.end};
}

std::optional<WideSegment> SegmentWidener::spherical(const DVec3& a, const DVec3& b) const {
  DVec3 v = a - rays_.position_, w = b - rays_.position_;
  const DVec3 normal = glm::cross(w, v);
  const double area = std::sqrt(glm::dot(normal, normal));
  double start = 0, end = 1;
  DVec3 side, along;
  if (area > angle_ * std::sqrt(glm::dot(v, v) * glm::dot(w, w)) ||
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
    const double half = kHalfWidth * angle_ * std::sqrt(glm::dot(from, from));
    return Vec3(rays_.position_ + from + side * (sideward * half) + along * (onward * half));
  };
  return WideSegment{
      .corners = {corner(v, 1, -1), corner(v, -1, -1), corner(w, -1, 1), corner(w, 1, 1)},
      .start = start,
      .end = end};
}

}  // namespace microtrace
