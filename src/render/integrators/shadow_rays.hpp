#pragma once
/// Shadow rays, and the light that arrives.

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

/// Shadow rays, traced in batches.
class ShadowRays {
 public:
  /// Adds a ray with a spawned origin. `light` is added to colors[slot] if it is not occluded. At
  /// most kRandomBatch rays.
  void add(const Vec3& origin, const LightSample& light, const Vec3& color, std::size_t slot);

  [[nodiscard]] std::size_t count() const { return free_.count + aimed_.count; }

  /// Adds the light that arrives to the colors and clears the rays. Returns the number of calls of
  /// Bvh::next.
  std::uint64_t trace(const Bvh& bvh, const Shading& shading, Backfaces backfaces,
                      std::span<Vec3> colors);

 private:
  /// A group of rays that all end at an emissive surface, or that all have no such end.
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
  Group met_;  ///< rays without a target that hit a surface that may transmit light
};

}  // namespace microtrace
