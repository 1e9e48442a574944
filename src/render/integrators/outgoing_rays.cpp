#include "render/integrators/outgoing_rays.hpp"

namespace microtrace {

std::size_t OutgoingRays::spawn_origins(const Bvh& bvh, ShadowRays& shadow_rays,
                                        std::span<Ray> rays, std::span<PathState> paths) {
  bvh.spawn_origins(std::span(spawns_).first(spawn_count_),
                    std::span(origins_).first(spawn_count_));
  // Drops rays without an origin: there is no float32 point between two walls.
  for (const Shadow& shadow : std::span(shadows_).first(shadow_count_)) {
    if (const auto& origin = origins_[shadow.spawn])
      shadow_rays.add(*origin, shadow.light, shadow.color, shadow.slot);
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < path_count_; ++i) {
    const std::size_t spawn = path_spawns_[i];
    if (!origins_[spawn]) continue;
    rays[count] = {.o = *origins_[spawn], .t_min = 0, .d = spawns_[spawn].direction};
    paths[count++] = paths_[i];
  }
  shadow_count_ = path_count_ = spawn_count_ = 0;
  return count;
}

}  // namespace microtrace
