#pragma once
/// Lights without size (KHR_lights_punctual).

#include "render/lights/light_sample.hpp"

#include <microtrace/light.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// About how much light it sends, to choose among several: lumens; of a directional light as much
/// as falls on a disc of radius 1.
[[nodiscard]] float punctual_power(const Light& light);

/// Nothing where none of it comes.
[[nodiscard]] std::optional<LightSample> of_punctual(const Light& light, const Vec3& p);

}  // namespace microtrace
