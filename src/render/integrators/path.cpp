#include "base/idle_objects.hpp"
#include "render/integrators/wavefront/wave.hpp"

#include <microtrace/path.hpp>

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

namespace microtrace {

/// The wavefronts of all threads. Creating one takes as long as a tenth of its work.
class PathIntegrator::Waves {
 public:
  std::unique_ptr<Wave> take() { return idle_.take(); }

  void give(std::unique_ptr<Wave> wave) {
    {
      const std::scoped_lock lock(mutex_);
      counts_ += wave->take_counts();
    }
    idle_.give(std::move(wave));
  }

  RayCounts counts() {
    const std::scoped_lock lock(mutex_);
    return counts_;
  }

 private:
  std::mutex mutex_;
  RayCounts counts_{};
  IdleObjects<Wave> idle_;
};

RayCounts& RayCounts::operator+=(const RayCounts& other) {
  const auto add = [](Kind& kind, const Kind& more) {
    kind.rays += more.rays;
    kind.seconds += more.seconds;
  };
  add(camera, other.camera);
  add(path, other.path);
  add(shadow, other.shadow);
  beyond += other.beyond;
  return *this;
}

PathIntegrator::PathIntegrator(const PathOptions& options)
    : options_(options), waves_(std::make_unique<Waves>()) {}
PathIntegrator::~PathIntegrator() = default;

void PathIntegrator::trace(const World& world, std::span<const Ray> rays,
                           std::span<const SampleId> ids, std::span<Sample> samples) const {
  std::unique_ptr<Wave> wave = waves_->take();
  wave->trace(world, options_, rays, ids, samples);
  waves_->give(std::move(wave));
}

std::optional<Sample> PathIntegrator::common_sample(const World& world,
                                                    const Frustum& frustum) const {
  const Lighting& lighting = *world.lighting;
  const bool is_seen = lighting.has_environment() && lighting.is_seen();
  if (options_.ground || (is_seen && !lighting.has_uniform_environment())) return std::nullopt;
  const CommonHit hit = world.bvh.common_hit(frustum);
  if (!hit.is_known || hit.id) return std::nullopt;
  if (!is_seen) return Sample{};
  return Sample{.color = lighting.environment(Vec3(0, 0, 1)), .alpha = 1};
}

RayCounts PathIntegrator::ray_counts() const {
  return waves_->counts();
}

}  // namespace microtrace
