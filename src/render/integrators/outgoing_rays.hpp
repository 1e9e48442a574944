#pragma once
/// Collects rays that leave surfaces, because computing their origins in batches is faster.

#include "render/integrators/path_state.hpp"
#include "render/integrators/shadow_rays.hpp"
#include "render/lights/light_sample.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/integrator.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <new>
#include <optional>
#include <span>

namespace microtrace {

/// The shadow rays and next rays of a bounce. Each path has at most one of each. This is a large
/// object.
class OutgoingRays {
 public:
  /// Adds a shadow ray. `hit` must be a hit of `ray`, which must remain valid until
  /// spawn_origins().
  void add_shadow(const Ray& ray, const Hit& hit, const LightSample& light, const Vec3& color,
                  std::size_t slot) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    // A punctual light is at t = 1. An emissive triangle is hit at about t = 1.
    const float t_max = light.is_far || light.target ? kInfinity : 1;
    shadow_spawns_[shadow_count_] = spawn(ray, hit, light.to_light);
    ::new (&shadows_[shadow_count_++])
        ShadowRays::Shadow{.color = color, .t_max = t_max, .slot = slot, .target = light.target};
  }

  /// Adds the next ray of a path, in this direction. Returns the path's state, which the caller
  /// must fill in.
  [[nodiscard]] PathState& add_path(const Ray& ray, const Hit& hit, const Vec3& direction) {
    path_spawns_[path_count_] = spawn(ray, hit, direction);
    return paths_[path_count_++];
  }

  /// Adds the next ray of a path that was scattered in a medium.
  void add_scattered(const Ray& ray, const PathState& path) {
    scattered_rays_[scattered_count_] = ray;
    scattered_[scattered_count_++] = path;
  }

  /// The next rays of paths, and the primitives that they leave.
  struct Paths {
    std::span<Ray> rays;
    std::span<PrimitiveId> left;
    std::span<PathState> states;
  };
  /// Computes the origins and drops rays without an origin. Returns the number of remaining path
  /// rays.
  std::size_t spawn_origins(const Bvh& bvh, ShadowRays& shadow_rays, const Paths& paths);

 private:
  std::size_t spawn(const Ray& ray, const Hit& hit, const Vec3& direction) {
    // Creates the spawn in place, because copying a struct that was just written in parts is slow.
    ::new (&spawns_[spawn_count_]) Bvh::Spawn{.ray = &ray, .hit = hit, .direction = direction};
    return spawn_count_++;
  }

  std::size_t shadow_count_ = 0, path_count_ = 0, spawn_count_ = 0, scattered_count_ = 0;
  std::array<ShadowRays::Shadow, kRandomBatch> shadows_;
  std::array<PathState, kRandomBatch> paths_, scattered_;
  std::array<Ray, kRandomBatch> scattered_rays_;
  std::array<std::size_t, kRandomBatch> shadow_spawns_, path_spawns_;
  std::array<Bvh::Spawn, 2 * kRandomBatch> spawns_;
  std::array<std::optional<Vec3>, 2 * kRandomBatch> origins_;
};

}  // namespace microtrace
