#pragma once
/// Punctual lights (KHR_lights_punctual).

#include "render/lanes/light_lanes.hpp"
#include "render/lights/light_sample.hpp"
#include "render/lights/light_tree.hpp"

#include <microtrace/light.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// Bounds for the light tree; nothing for directional lights.
[[nodiscard]] std::optional<LightBounds> punctual_bounds(const Light& light);

/// The light in the form that kernels need.
[[nodiscard]] PunctualLight punctual_light(const Light& light);

/// The light that arrives at p; nothing if the light doesn't reach p.
[[nodiscard]] std::optional<FoundLight> of_punctual(const PunctualLight& light, const Vec3& p);

}  // namespace microtrace
