#include "render/lights/environment_light.hpp"

#include "render/lights/studio.hpp"
#include "render/luminance.hpp"
#include "scene/turns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <variant>

namespace microtrace {
namespace {

constexpr float kUniformPdf = static_cast<float>(0.25 / std::numbers::pi);

/// x in [0, size), whatever comes; not a number gives 0.
float clamped(float x, float size) {
  if (!(x >= 0)) return 0;
  return x < size ? x : std::nextafter(size, 0.0F);
}

/// The part of a turn beyond whole turns, in [0, 1).
float part_of_turn(double radians) {
  const double turns = radians / (2 * std::numbers::pi);
  const auto part = static_cast<float>(turns - std::floor(turns));
  return part < 1 ? part : 0;
}

std::shared_ptr<const RadianceMap> map_of(const Environment& environment) {
  if (std::holds_alternative<Studio>(environment.content))
    return std::make_shared<const RadianceMap>(make_studio());
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&environment.content);
  return map != nullptr ? *map : nullptr;
}

}  // namespace

EnvironmentLight::EnvironmentLight(const Environment& environment)
    : map_(map_of(environment)),
      intensity_(environment.intensity),
      turn_(part_of_turn(environment.rotation)),
      back_turn_(part_of_turn(-std::numbers::pi - environment.rotation)) {
  if (map_) {
    distribution_.emplace(*map_);
    width_ = static_cast<float>(map_->width);
    height_ = static_cast<float>(map_->height);
    mean_luminance_ = static_cast<float>(distribution_->mean_luminance() * double{intensity_});
  } else {
    uniform_ = intensity_ * std::get<Vec3>(environment.content);
    mean_luminance_ = luminance(uniform_);
  }
}

EnvironmentLight::Place EnvironmentLight::place_of(const Vec3& d) const {
  const float axis_range = std::sqrt(d.x * d.x + d.z * d.z);
  const float turns = atan2_turns(d.z, d.x) + (0.5F + turn_);  // in [0, 2)
  const float u = turns - chosen(turns >= 1, 1, 0);
  return {.x = clamped(u * width_, width_), .y = row_of(axis_range, d.y)};
}

float EnvironmentLight::row_of(float axis_range, float height) const {
  // Precise at the poles, as acos(y) is not.
  return clamped(2 * height_ * atan2_turns(axis_range, height), height_);
}

Vec3 EnvironmentLight::radiance_at(Place place) const {
  const std::uint32_t width = map_->width, height = map_->height;
  // From 0 on, pixels' centres lie at whole numbers; one is added so that they stay positive.
  const float x = place.x + 0.5F, y = place.y + 0.5F;
  const auto column = static_cast<std::uint32_t>(x), line = static_cast<std::uint32_t>(y);
  const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(line);
  const std::uint32_t left = column > 0 ? column - 1 : width - 1;
  const std::uint32_t right = column < width ? column : 0;
  const std::uint32_t above = line > 0 ? line - 1 : 0, below = std::min(line, height - 1);
  const Vec3* upper = &map_->pixels[std::size_t{above} * width];
  const Vec3* lower = &map_->pixels[std::size_t{below} * width];
  const Vec3 high = (1 - fx) * upper[left] + fx * upper[right];
  const Vec3 low = (1 - fx) * lower[left] + fx * lower[right];
  return intensity_ * ((1 - fy) * high + fy * low);
}

float EnvironmentLight::pdf_at(Place place) const {
  return distribution_->density(static_cast<std::uint32_t>(place.x),
                                static_cast<std::uint32_t>(place.y));
}

Vec3 EnvironmentLight::radiance(const Vec3& direction) const {
  return map_ ? radiance_at(place_of(direction)) : uniform_;
}

float EnvironmentLight::pdf(const Vec3& direction) const {
  return map_ ? pdf_at(place_of(direction)) : kUniformPdf;
}

EnvironmentLight::Sample EnvironmentLight::sample(const Vec2& u) const {
  if (!map_) {
    const float h = u.y, r = 2 * std::sqrt(h * (1 - h));
    const SineCosine angle = sin_cos_turns(u.x);
    return {.wi = {r * angle.cosine, 1 - 2 * h, r * angle.sine},
            .radiance = uniform_,
            .pdf = kUniformPdf};
  }
  const MapDistribution::Point point = distribution_->sample(u);
  const float turns = point.column / width_ + back_turn_;  // in [0, 2]
  const SineCosine angle = sin_cos_turns(turns - chosen(turns >= 1, 1, 0));
  const Place place{.x = clamped(point.column, width_),
                    .y = row_of(point.axis_range, point.height)};
  return {.wi = {point.axis_range * angle.cosine, point.height, point.axis_range * angle.sine},
          .radiance = radiance_at(place),
          .pdf = point.density};
}

}  // namespace microtrace
