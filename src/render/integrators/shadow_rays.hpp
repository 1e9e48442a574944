#pragma once
/// Light on its way to surfaces, and whether it arrives.

#include "render/lights/light_sample.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/path.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

/// Rays from surfaces to lights, asked together.
class ShadowRays {
 public:
  /// From a spawned origin. `light` is for colors[slot] if nothing is in between. At most
  /// kRandomBatch.
  void add(const Vec3& origin, const LightSample& light, const Vec3& color, std::size_t slot);

  [[nodiscard]] std::size_t count() const { return free_.count + aimed_.count; }

  /// Adds what arrives to the colours and forgets the rays. Returns how many hits behind hits were
  /// asked for.
  std::uint64_t arrive(const Bvh& bvh, const Shading& shading, Backfaces backfaces,
                       std::span<Vec3> colors);

 private:
  /// Those that end at a triangle that shines, or those that end nowhere else.
  struct Group {
    std::size_t count = 0;
    std::array<Ray, kRandomBatch> rays;
    std::array<Vec3, kRandomBatch> light;
    std::array<std::size_t, kRandomBatch> slots;
    std::array<std::optional<PrimitiveId>, kRandomBatch> targets;

    void add(const Ray& ray, const Vec3& color, std::size_t slot,
             const std::optional<PrimitiveId>& target);
  };

  static std::uint64_t pass_layers(const Bvh& bvh, const Shading& shading, bool passes_backs,
                                   Group& group, std::span<Vec3> colors);

  Group free_, aimed_;
  Group met_;  ///< of the free ones those that meet something that may let light through
};

}  // namespace microtrace
