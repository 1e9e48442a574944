#include "render/lights/punctual.hpp"

#include "render/lights/sample_punctual.hpp"
#include "scene/math/luminance.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Replaces infinity by the largest float32.
double finite(float intensity) {
  return std::min(intensity, std::numeric_limits<float>::max());
}

void put(double (&to)[3], const DVec3& v) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = v[axis];
}

void put_cone(PunctualLight& to, const SpotLight& light) {
  put(to.axis, light.direction);
  to.outer_cosine = cos_radians(light.outer_angle);
  to.penumbra = std::max(cos_radians(light.inner_angle) - to.outer_cosine, 1e-9);
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
  // there. No light leaves the cone.
  return bounds_at(light.position, light.color, light.intensity,
                   {.axis = Vec3(light.direction),
                    .cos_o = static_cast<float>(cos_radians(light.outer_angle)) - 1e-6F,
                    .cos_e = 1});
}

}  // namespace

std::optional<LightBounds> punctual_bounds(const Light& light) {
  return std::visit([](const auto& l) { return bounds(l); }, light);
}

PunctualLight punctual_light(const Light& light) {
  PunctualLight result{};
  result.outer_cosine = -1;
  result.penumbra = 1;
  std::visit(
      [&]<class AnyLight>(const AnyLight& l) {
        put(result.color, DVec3(l.color));
        result.intensity = finite(l.intensity);
        if constexpr (std::is_same_v<AnyLight, DirectionalLight>) {
          put(result.axis, -l.direction);
          result.is_directional = 1;
        } else {
          put(result.position, l.position);
          result.range = l.range;
        }
        if constexpr (std::is_same_v<AnyLight, SpotLight>) put_cone(result, l);
      },
      light);
  return result;
}

std::optional<FoundLight> of_punctual(const PunctualLight& light, const Vec3& p) {
  const PunctualLights<1> lights([&](int) -> const PunctualLight& { return light; });
  const PunctualSamples<1> found = lights.at(DVec3(p));
  if (found.is_lit == 0) return std::nullopt;
  return FoundLight{.to_light = found.to_light,
                    .is_far = light.is_directional != 0,
                    .wi = found.wi,
                    .light = found.light};
}

}  // namespace microtrace
