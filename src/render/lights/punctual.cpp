#include "render/lights/punctual.hpp"

#include "scene/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

constexpr double kPi = std::numbers::pi;

/// The extension's window: from 1 down to 0 at the range.
double window(double distance, double range) {
  const double q = distance / range;
  const double w = std::clamp(1 - q * q * q * q, 0.0, 1.0);
  return std::isfinite(range) ? w : 1;
}

std::optional<LightSample> from_place(const DVec3& place, const Vec3& p, const Vec3& color,
                                      double intensity, double range) {
  const DVec3 way = place - DVec3(p);
  const double square = glm::dot(way, way);
  if (!(square > 0)) return std::nullopt;
  const double distance = std::sqrt(square);
  const double irradiance = intensity * window(distance, range) / square;
  if (!(irradiance > 0)) return std::nullopt;
  return LightSample{.way = Vec3(way),
                     .wi = Vec3(way / distance),
                     .light = static_cast<float>(irradiance) * color};
}

std::optional<LightSample> sample(const DirectionalLight& light, const Vec3&) {
  const Vec3 wi(-light.direction);
  return LightSample{.way = wi, .is_far = true, .wi = wi, .light = light.intensity * light.color};
}

std::optional<LightSample> sample(const PointLight& light, const Vec3& p) {
  return from_place(light.position, p, light.color, light.intensity, light.range);
}

std::optional<LightSample> sample(const SpotLight& light, const Vec3& p) {
  const DVec3 way = DVec3(p) - light.position;
  const double square = glm::dot(way, way);
  if (!(square > 0)) return std::nullopt;
  const double cosine = glm::dot(way, light.direction) / std::sqrt(square);
  const double inner = cos_radians(light.inner_angle), outer = cos_radians(light.outer_angle);
  const double inside = std::clamp((cosine - outer) / std::max(inner - outer, 1e-9), 0.0, 1.0);
  return from_place(light.position, p, light.color, light.intensity * inside * inside, light.range);
}

double solid_angle(const DirectionalLight&) {
  return kPi;
}
double solid_angle(const PointLight&) {
  return 4 * kPi;
}
double solid_angle(const SpotLight& light) {
  return 2 * kPi * (1 - cos_radians((light.inner_angle + light.outer_angle) / 2));
}

}  // namespace

float punctual_power(const Light& light) {
  return std::visit(
      [](const auto& l) {
        const Vec3& c = l.color;
        const double brightness = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
        return static_cast<float>(solid_angle(l) * l.intensity * brightness);
      },
      light);
}

std::optional<LightSample> of_punctual(const Light& light, const Vec3& p) {
  return std::visit([&](const auto& l) { return sample(l, p); }, light);
}

}  // namespace microtrace
