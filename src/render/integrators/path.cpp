#include "render/integrators/wave.hpp"

#include <microtrace/path.hpp>

#include <memory>

namespace microtrace {

void PathIntegrator::trace(const World& world, std::span<const Ray> rays,
                           std::span<const SampleId> ids, std::span<Sample> samples) const {
  const auto wave = std::make_unique<Wave>(world, options_, rays, ids);  // too large for a stack
  wave->trace(samples);
}

}  // namespace microtrace
