#pragma once
/// Values of exact quantities (AOVs).

#include <microtrace/aov.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/surface_interaction.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

/// Finds the first visible surface of each ray, as defined by Aov.
void find_seen(const World& world, std::span<const Ray> rays, std::span<std::optional<Hit>> hits);

/// A visible surface and the ray that hits it.
struct Sight {
  const World& world;
  const Ray& ray;
  Hit hit;
  SurfaceInteraction at;
};

/// All quantities but id.
[[nodiscard]] std::array<float, 3> value_of(Aov aov, const Sight& sight);
[[nodiscard]] std::array<float, 3> value_of_nothing(Aov aov);

/// The ids of instance, primitive and material.
[[nodiscard]] std::array<std::uint32_t, 3> ids_of(const World& world,
                                                  const std::optional<Hit>& hit);

}  // namespace microtrace
