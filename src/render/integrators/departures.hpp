#pragma once
/// Rays that leave surfaces, before their origins are found: all of a wave at once, which is
/// faster.

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

/// Each path leaves a surface at most once to a light and once to go on. Large.
class Departures {
 public:
  /// `ray` stays until set_off(), and hits there.
  void add_shadow(const Ray& ray, const Hit& hit, const LightSample& light, const Vec3& color,
                  std::size_t slot) {
    shadows_[shadow_count_++] = {
        .light = light, .color = color, .slot = slot, .spawn = spawn(ray, hit, light.to_light)};
  }

  /// The path that goes on in that direction, to be filled in.
  [[nodiscard]] PathState& add_path(const Ray& ray, const Hit& hit, const Vec3& direction) {
    path_spawns_[path_count_] = spawn(ray, hit, direction);
    return paths_[path_count_++];
  }

  /// Gives them origins; those that have no room to leave end. Returns how many rays of paths there
  /// are.
  std::size_t set_off(const Bvh& bvh, ShadowRays& shadow_rays, std::span<Ray> rays,
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
