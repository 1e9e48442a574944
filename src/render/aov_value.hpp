#pragma once
/// The numbers of exact outputs.

#include <microtrace/aov.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/surface_interaction.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace microtrace {

/// The names of an output's numbers, at most three.
[[nodiscard]] std::span<const std::string_view> channels_of(Aov aov);

/// Turns the first hits of rays into those of surfaces that are there, as Aov says.
void find_seen(const World& world, std::span<const Ray> rays, std::span<std::optional<Hit>> hits);

/// What a ray sees.
struct Sight {
  const World& world;
  const Ray& ray;
  Hit hit;
  SurfaceInteraction at;
};

/// Each but id.
[[nodiscard]] std::array<float, 3> value_of(Aov aov, const Sight& sight);
[[nodiscard]] std::array<float, 3> value_of_nothing(Aov aov);

/// Instance, primitive and material.
[[nodiscard]] std::array<std::uint32_t, 3> ids_of(const World& world,
                                                  const std::optional<Hit>& hit);

}  // namespace microtrace
