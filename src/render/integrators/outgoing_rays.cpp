#include "render/integrators/outgoing_rays.hpp"

#include <new>

namespace microtrace {

std::size_t OutgoingRays::spawn_origins(const Bvh& bvh, ShadowRays& shadow_rays,
                                        const Paths& paths) {
  bvh.spawn_origins(std::span(spawns_).first(spawn_count_),
                    std::span(origins_).first(spawn_count_));
  // Drops rays without an origin. A ray between two walls has none if no float32 point lies between
  // them.
  for (std::size_t i = 0; i < shadow_count_; ++i) {
    const Bvh::Spawn& spawn = spawns_[shadow_spawns_[i]];
    if (const auto& origin = origins_[shadow_spawns_[i]])
      shadow_rays.add(shadows_[i], *origin, spawn.direction, spawn.hit.id);
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < path_count_; ++i) {
    const Bvh::Spawn& spawn = spawns_[path_spawns_[i]];
    const auto& origin = origins_[path_spawns_[i]];
    if (!origin) continue;
    ::new (&paths.rays[count]) Ray{.o = *origin, .t_min = 0, .d = spawn.direction};
    paths.left[count] = spawn.hit.id;
    paths.states[count++] = paths_[i];
  }
  for (std::size_t i = 0; i < scattered_count_; ++i) {
    paths.rays[count] = scattered_rays_[i];
    paths.left[count] = kNoPrimitive;
    paths.states[count++] = scattered_[i];
  }
  shadow_count_ = path_count_ = spawn_count_ = scattered_count_ = 0;
  return count;
}

}  // namespace microtrace
