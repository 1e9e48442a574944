#pragma once
/// Path tracing.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/tone_map.hpp>

#include <cstdint>
#include <memory>
#include <optional>

namespace microtrace {

/// What happens to light paths that meet the back of a one-sided surface (glTF's doubleSided
/// false). The camera never sees such backs. Surfaces that enclose a medium (KHR_materials_volume)
/// are always two-sided.
enum class Backfaces {
  pass,     ///< paths pass through, like camera rays, so hulls seen from inside don't block light
  occlude,  ///< paths are blocked, so one-sided walls block sunlight that comes from behind them
};

/// The formulas for surfaces.
enum class BsdfModel {
  conserving,  ///< returns the light that the specification's formulas lose between microfacets and
               ///< between layers; reciprocal
  /// The formulas that glTF 2.0, appendix B, and the material extensions give, for comparisons with
  /// renderers that implement them. Rough metals are darker, and smooth sheen may reflect more
  /// light than it receives.
  spec,
};

/// A horizontal plane that shows only shadows: a shadow catcher. Camera rays meet it from above
/// where they meet no surface. There, the picture is black with the occluded fraction of the
/// ground's light as alpha, or the environment is darkened by this fraction if it is the
/// background. The light is that of the environment and the punctual lights; emissive surfaces cast
/// no light on the ground. The ground has no other effect on the scene.
struct Ground {
  /// The y coordinate in world space. Nothing: that of the lowest point of all bounded shapes;
  /// there is no ground if there are none.
  std::optional<double> height;
};

struct PathOptions {
  /// The maximum path length in segments between surfaces: 1 is emission only, 2 adds direct light.
  /// At least 1. Scattering events in media don't count.
  std::uint32_t max_depth = 32;
  Backfaces backfaces = Backfaces::pass;
  BsdfModel bsdf = BsdfModel::conserving;
  std::optional<Ground> ground{};
  /// True if paths first learn where light arrives from, and then prefer these directions. Pictures
  /// have the same mean, but different noise. Can't be combined with a shutter.
  bool guiding = false;
};

/// Path tracing (J. Kajiya, The rendering equation, 1986) with the scene's lights, its environment,
/// its emissive surfaces, and the materials of glTF 2.0, appendix B. The expected value of a sample
/// is the radiance without the contribution of paths longer than max_depth.
class MICROTRACE_EXPORT PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const PathOptions& options = {});
  ~PathIntegrator() override;

  [[nodiscard]] const PathOptions& options() const { return options_; }
  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override;
  [[nodiscard]] std::optional<Sample> common_sample(const World& world,
                                                    const Frustum& frustum) const override;
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
