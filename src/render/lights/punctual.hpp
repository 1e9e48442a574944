#pragma once
/// Lights without size (KHR_lights_punctual).

#include "render/lights/light_sample.hpp"
#include "render/lights/light_tree.hpp"

#include <microtrace/light.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// To choose among several; nothing for light from infinitely far.
[[nodiscard]] std::optional<LightBounds> punctual_bounds(const Light& light);

/// Nothing where none of it comes.
[[nodiscard]] std::optional<FoundLight> of_punctual(const Light& light, const Vec3& p);

}  // namespace microtrace
