#include "render/lights/environment_light.hpp"

#include "render/lights/studio.hpp"
#include "render/luminance.hpp"
#include "scene/math/revolutions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <variant>

#include <glm/common.hpp>

namespace microtrace {
namespace {

/// The maximum intensity. The product with the greatest radiance of a map, 2^30, is kBrightest.
constexpr float kGreatestIntensity = kBrightest / 0x1p30F;

constexpr float kUniformPdf = static_cast<float>(0.25 / std::numbers::pi);

/// Clamps x to [0, size). NaN gives 0.
float clamped(float x, float size) {
  if (!(x >= 0)) return 0;
  return x < size ? x : std::nextafter(size, 0.0F);
}

/// The distance of a direction's end point from the y axis.
float axis_range_of(const Vec3& d) {
  return std::sqrt(d.x * d.x + d.z * d.z);
}

/// Converts an angle to the fractional part of its revolutions, in [0, 1).
float part_of_turn(double radians) {
  const double turns = radians / (2 * std::numbers::pi);
  const auto part = static_cast<float>(turns - std::floor(turns));
  return part < 1 ? part : 0;
}

std::shared_ptr<const MapTables> studio_tables() {
  static const auto tables = std::make_shared<const MapTables>(
      std::make_shared<const RadianceMap>(make_studio()), MemoryAccount(nullptr));
  return tables;
}

}  // namespace

std::shared_ptr<const MapTables> tables_of(const Environment& environment) {
  if (std::holds_alternative<Vec3>(environment.content)) return nullptr;
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&environment.content);
  if (map == nullptr) return studio_tables();
  constexpr std::uint64_t kBytesOfPixel = 16;
  return std::make_shared<const MapTables>(
      *map, temporary_memory((*map)->pixels.size() * kBytesOfPixel,
                             "the sampling tables of the environment"));
}

EnvironmentLight::EnvironmentLight(const Environment& environment,
                                   std::shared_ptr<const MapTables> tables)
    : tables_(std::move(tables)),
      intensity_(std::min(environment.intensity, kGreatestIntensity)),
      turn_(part_of_turn(environment.rotation)),
      back_turn_(part_of_turn(-std::numbers::pi - environment.rotation)) {
  if (tables_) {
    const MapDistribution& distribution = tables_->distribution;
    width_ = static_cast<float>(tables_->map->width);
    height_ = static_cast<float>(tables_->map->height);
    mean_luminance_ = static_cast<float>(distribution.mean_luminance() * double{intensity_});
    sampled_luminance_ = static_cast<float>(distribution.sampled_luminance() * double{intensity_});
  } else {
    uniform_ = glm::min(intensity_ * std::get<Vec3>(environment.content), Vec3(kBrightest));
    mean_luminance_ = luminance(uniform_);
    sampled_luminance_ = mean_luminance_ * MapDistribution::kLeastPart;
  }
}

ImageSize EnvironmentLight::map_size() const {
  if (!tables_) return {.width = 1, .height = 1};
  return {.width = tables_->map->width, .height = tables_->map->height};
}

MapPlace EnvironmentLight::place_of(const Vec3& d, float axis_range) const {
  const float turns = atan2_revolutions(d.z, d.x) + (0.5F + turn_);  // in [0, 2)
  const float u = turns - chosen(turns >= 1, 1, 0);
  // In these coordinates, the center of pixel k is at k + 1, which keeps x positive.
  const float x = clamped(u * width_, width_) + 0.5F;
  // atan2 is precise at the poles, unlike acos(y).
  const float y = clamped(2 * height_ * atan2_revolutions(axis_range, d.y), height_) + 0.5F;
  const auto column = static_cast<std::uint32_t>(x), line = static_cast<std::uint32_t>(y);
  return {.column = column < tables_->map->width ? column : 0,
          .line = line,
          .x = x - static_cast<float>(column),
          .y = y - static_cast<float>(line)};
}

EnvironmentLight::Lookup EnvironmentLight::lookup(const Vec3& direction) const {
  if (!tables_) return {.radiance = uniform_, .pdf = kUniformPdf};
  const float axis_range = axis_range_of(direction);
  const MapPlace place = place_of(direction, axis_range);
  const auto corners = corners_of(*tables_->map, place);
  return {.radiance = intensity_ * bilinear(corners, place.x, place.y),
          .pdf = tables_->distribution.pdf(place, corners, axis_range)};
}

Vec3 EnvironmentLight::radiance(const Vec3& direction) const {
  if (!tables_) return uniform_;
  const MapPlace place = place_of(direction, axis_range_of(direction));
  return intensity_ * bilinear(corners_of(*tables_->map, place), place.x, place.y);
}

void EnvironmentLight::sample(std::span<const Vec2> u, std::span<Sample> samples) const {
  if (!tables_) {
    for (std::size_t i = 0; i < u.size(); ++i) samples[i] = uniform_sample(u[i]);
    return;
  }
  std::array<MapDistribution::Point, MapDistribution::kMostSamples> points;
  tables_->distribution.sample(u, points);
  for (std::size_t i = 0; i < u.size(); ++i) samples[i] = sample_at(points[i]);
}

EnvironmentLight::Sample EnvironmentLight::uniform_sample(const Vec2& u) const {
  const float h = u.y, r = 2 * std::sqrt(h * (1 - h));
  const SineCosine angle = sin_cos_revolutions(u.x);
  return {.wi = {r * angle.cosine, 1 - 2 * h, r * angle.sine},
          .radiance = uniform_,
          .pdf = kUniformPdf};
}

EnvironmentLight::Sample EnvironmentLight::sample_at(const MapDistribution::Point& point) const {
  const MapPlace& place = point.place;
  const float column = static_cast<float>(place.column) + (place.x - 0.5F);
  float turns = column / width_ + back_turn_;  // in [-1/2, 2]
  turns -= chosen(turns >= 1, 1, 0);
  turns += chosen(turns < 0, 1, 0);
  const SineCosine angle = sin_cos_revolutions(turns);
  return {.wi = {point.axis_range * angle.cosine, point.height, point.axis_range * angle.sine},
          .radiance = intensity_ * bilinear(corners_of(*tables_->map, place), place.x, place.y),
          .pdf = point.pdf};
}

}  // namespace microtrace
