#pragma once
/// Rays that leave surfaces, whose origins are computed in batches, which is faster.

#include "render/integrators/path_state.hpp"
#include "render/integrators/shadow_rays.hpp"
#include "render/lights/light_sample.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/integrator.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace microtrace {

/// Each path has at most one shadow ray and one next ray. A large object.
class OutgoingRays {
 public:
  /// `ray` must remain valid until spawn_origins(), and must have this hit.
  void add_shadow(const Ray& ray, const Hit& hit, const LightSample& light, const Vec3& color,
                  std::size_t slot) {
    shadows_[shadow_count_++] = {
        .light = light, .color = color, .slot = slot, .spawn = spawn(ray, hit, light.to_light)};
  }

  /// The state of the path that continues in this direction, to be filled in.
  [[nodiscard]] PathState& add_path(const Ray& ray, const Hit& hit, const Vec3& direction) {
    path_spawns_[path_count_] = spawn(ray, hit, direction);
    return paths_[path_count_++];
  }

  /// Computes the origins; rays without an origin are dropped. Returns the number of remaining path
  /// rays.
  std::size_t spawn_origins(const Bvh& bvh, ShadowRays& shadow_rays, std::span<Ray> rays,
                            std::span<PathState> paths);

 private:
  struct Shadow {
    LightSample light;
    Vec3 color;
    std::size_t slot, spawn;
  };

  std::size_t spawn(const Ray& ray, const Hit& hit, const Vec3& direction) {
    spawns_[spawn_count_] = {.ray = &ray, .hit = hit, .direction = direction};
    return spawn_count_++;
  }

  std::size_t shadow_count_ = 0, path_count_ = 0, spawn_count_ = 0;
  std::array<Shadow, kRandomBatch> shadows_;
  std::array<PathState, kRandomBatch> paths_;
  std::array<std::size_t, kRandomBatch> path_spawns_;
  std::array<Bvh::Spawn, 2 * kRandomBatch> spawns_;
  std::array<std::optional<Vec3>, 2 * kRandomBatch> origins_;
};

}  // namespace microtrace
