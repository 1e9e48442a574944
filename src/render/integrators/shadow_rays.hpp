#pragma once
/// Traces shadow rays and adds the light that arrives.

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

/// A batch of shadow rays.
class ShadowRays {
 public:
  /// A shadow ray, and the light that is added to colors[slot] if it is not occluded.
  struct Shadow {
    Vec3 color;
    float t_max;
    std::size_t slot;
    std::optional<PrimitiveId> target;  ///< the emissive surface at which the ray ends
  };

  /// Adds a ray that leaves the primitive `left` from a spawned origin. There may be at most
  /// kRandomBatch rays.
  void add(const Shadow& shadow, const Vec3& origin, const Vec3& direction, PrimitiveId left);

  [[nodiscard]] std::size_t count() const { return free_.count + aimed_.count; }

  /// Traces the rays, adds the light that arrives to the colors, and clears the rays. Returns the
  /// number of calls of Bvh::next.
  std::uint64_t trace(const Bvh& bvh, const Shading& shading, Backfaces backfaces,
                      std::span<Vec3> colors);

 private:
  /// A group of rays that all have a target, or that all have none.
  struct Group {
    std::size_t count = 0;
    std::array<Ray, kRandomBatch> rays;
    std::array<Vec3, kRandomBatch> light;
    std::array<std::size_t, kRandomBatch> slots;
    std::array<std::optional<PrimitiveId>, kRandomBatch> targets;
    std::array<PrimitiveId, kRandomBatch> left;

    /// Completes the entry whose ray is rays[count], and counts it.
    void finish(const Shadow& shadow, PrimitiveId surface);
  };

  std::uint64_t pass_layers(const Bvh& bvh, const Shading& shading, bool passes_backs, Group& group,
                            std::span<Vec3> colors);

  std::array<std::optional<Hit>, kRandomBatch> hits_;  // working memory
  Group free_, aimed_;
  Group met_;  ///< rays without a target that hit a surface that may transmit light
};

}  // namespace microtrace
