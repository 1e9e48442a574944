#pragma once
/// Path tracing.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/tone_map.hpp>

#include <cstdint>
#include <memory>

namespace microtrace {

/// What happens to light paths that meet the back of a one-sided surface (glTF's doubleSided
/// false). The camera never sees such backs. Surfaces that enclose a medium (KHR_materials_volume)
/// are always two-sided.
enum class Backfaces {
  pass,     ///< paths pass through, like camera rays, so hulls seen from inside don't block light
  occlude,  ///< paths are blocked, so one-sided walls block sunlight that comes from behind them
};

struct PathOptions {
  /// The maximum path length: 1 is emission only, 2 adds direct light. At least 1.
  std::uint32_t max_depth = 32;
  Backfaces backfaces = Backfaces::pass;
};

/// Path tracing (J. Kajiya, The rendering equation, 1986) with the scene's lights, its environment,
/// its emissive surfaces, and the materials of glTF 2.0, appendix B. The expected value of a sample
/// is the radiance without the contribution of paths longer than max_depth.
class MICROTRACE_EXPORT PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const PathOptions& options = {});
  ~PathIntegrator() override;

  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override;
  [[nodiscard]] bool is_random() const override { return true; }
  [[nodiscard]] RayCounts ray_counts() const override;
  [[nodiscard]] Display display(const Film& /*film*/) const override {
    return {.tone_map = ToneMap::khronos_pbr_neutral};
  }

 private:
  class MICROTRACE_HIDDEN Waves;
  PathOptions options_;
  std::unique_ptr<Waves> waves_;
};

}  // namespace microtrace
