#pragma once
/// Shadow rays from the ground.

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

/// Returns the point, in scene coordinates, where a ray meets the horizontal plane at this y from
/// above; nothing if it doesn't. The point has exactly this y.
[[nodiscard]] std::optional<Vec3> point_on_ground(const Ray& ray, float height);

/// A batch of shadow rays from points on the ground.
class GroundShadows {
 public:
  /// Adds a ray from the point p. There may be at most kRandomBatch rays.
  void add(const Vec3& p, const Vec3& to_light, bool is_far, std::size_t slot);

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Traces the rays, calls darken(slot, occlusion) for each ray with the occluded fraction of its
  /// light, and removes the rays. Returns the number of calls of Bvh::next.
  template <class Darken>
  std::uint64_t trace(const Bvh& bvh, const Shading& shading, const PathOptions& options,
                      const Darken& darken) {
    const std::uint64_t beyond = find_occlusions(bvh, shading, options);
    for (std::size_t i = 0; i < count_; ++i) darken(slots_[i], occlusions_[i]);
    count_ = 0;
    return beyond;
  }

 private:
  std::uint64_t find_occlusions(const Bvh& bvh, const Shading& shading, const PathOptions& options);

  std::size_t count_ = 0;
  std::array<Ray, kRandomBatch> rays_;
  std::array<std::size_t, kRandomBatch> slots_;
  std::array<float, kRandomBatch> occlusions_;
};

}  // namespace microtrace
