#pragma once
/// Light on its way to surfaces, and whether it arrives.

#include "render/lights/light_sample.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/integrator.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace microtrace {

/// Rays from surfaces to lights, asked together.
class ShadowRays {
 public:
  /// From a spawned origin. `light` is for colors[slot] if nothing is in between. At most
  /// kRandomBatch.
  void add(const Vec3& origin, const LightSample& light, const Vec3& color, std::size_t slot);

  /// Adds what arrives to the colours, in the order of add(), and forgets the rays.
  void arrive(const Bvh& bvh, const Shading& shading, std::span<Vec3> colors);

 private:
  std::size_t count_ = 0;
  bool any_target_ = false;
  std::array<Ray, kRandomBatch> rays_;
  std::array<Vec3, kRandomBatch> light_;
  std::array<std::size_t, kRandomBatch> slots_;
  std::array<std::optional<PrimitiveId>, kRandomBatch> targets_;
};

}  // namespace microtrace
