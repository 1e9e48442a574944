#include "render/lights/punctual.hpp"

#include "render/luminance.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Replaces infinity by the largest float32.
double finite(float intensity) {
  return std::min(intensity, std::numeric_limits<float>::max());
}

/// The falloff window of KHR_lights_punctual, which decreases from 1 to 0 at the range.
double window(double distance, double range) {
  const double q = distance / range;
  const double w = std::clamp(1 - q * q * q * q, 0.0, 1.0);
  return std::isfinite(range) ? w : 1;
}

std::optional<FoundLight> from_place(const DVec3& place, const Vec3& p, const Vec3& color,
                                     double intensity, double range) {
  const DVec3 to_light = place - DVec3(p);
  const double square = glm::dot(to_light, to_light);
  if (!(square > 0)) return std::nullopt;
  const double distance = std::sqrt(square);
  const double irradiance = intensity * window(distance, range) / square;
  if (!(irradiance > 0) || !std::isfinite(distance)) return std::nullopt;
  return FoundLight{
      .to_light = to_light, .wi = Vec3(to_light / distance), .light = irradiance * DVec3(color)};
}

std::optional<FoundLight> sample(const DirectionalLight& light, const Vec3&) {
  const DVec3 wi = -light.direction;
  return FoundLight{.to_light = wi,
                    .is_far = true,
                    .wi = Vec3(wi),
                    .light = finite(light.intensity) * DVec3(light.color)};
}

std::optional<FoundLight> sample(const PointLight& light, const Vec3& p) {
  return from_place(light.position, p, light.color, finite(light.intensity), light.range);
}

std::optional<FoundLight> sample(const SpotLight& light, const Vec3& p) {
  const DVec3 to_light = DVec3(p) - light.position;
  const double square = glm::dot(to_light, to_light);
  if (!(square > 0)) return std::nullopt;
  const double cosine = glm::dot(to_light, light.direction) / std::sqrt(square);
  const double inner = cos_radians(light.inner_angle), outer = cos_radians(light.outer_angle);
  const double inside = std::clamp((cosine - outer) / std::max(inner - outer, 1e-9), 0.0, 1.0);
  return from_place(light.position, p, light.color, finite(light.intensity) * inside * inside,
                    light.range);
}

LightBounds bounds_at(const DVec3& place, const Vec3& color, float intensity,
                      const LightCone& cone) {
  const Vec3 p = finite_point(place);
  return {.low = p, .high = p, .power = finite(intensity) * luminance(DVec3(color)), .cone = cone};
}

std::optional<LightBounds> bounds(const DirectionalLight&) {
  return std::nullopt;
}
std::optional<LightBounds> bounds(const PointLight& light) {
  return bounds_at(light.position, light.color, light.intensity, {.cos_o = -1});
}
std::optional<LightBounds> bounds(const SpotLight& light) {
  // Ignores the falloff toward the edge of the light's cone. The light may be selected too often
  // there.
  return bounds_at(light.position, light.color, light.intensity,
                   {.axis = Vec3(light.direction),
                    .cos_o = static_cast<float>(cos_radians(light.outer_angle)) - 1e-6F});
}

}  // namespace

std::optional<LightBounds> punctual_bounds(const Light& light) {
  return std::visit([](const auto& l) { return bounds(l); }, light);
}

std::optional<FoundLight> of_punctual(const Light& light, const Vec3& p) {
  return std::visit([&](const auto& l) { return sample(l, p); }, light);
}

}  // namespace microtrace
