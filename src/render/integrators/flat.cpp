#include <microtrace/integrator.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace microtrace {

void FlatIntegrator::trace(const World& world, std::span<const Ray> rays,
                           std::span<Sample> samples) const {
  std::array<std::optional<Hit>, kMaxBatch> hits;
  world.bvh.intersect(rays, std::span(hits).first(rays.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    samples[i] = Sample{};
    if (!hits[i]) continue;
    const Object& object = world.bvh.primitives().object(hits[i]->id);
    samples[i] = {.color = Vec3(material_of(world.scene, object).base_color), .alpha = 1};
  }
}

}  // namespace microtrace
