#pragma once
/// Pictures with light.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/tone_map.hpp>

#include <cstdint>
#include <memory>

namespace microtrace {

/// What light does at the back of what is one-sided (glTF's doubleSided false), through which the
/// camera looks. What encloses a medium (KHR_materials_volume) has both sides.
enum class Backfaces {
  pass,     ///< goes on, as rays of the camera do: hulls seen from within hide no light
  occlude,  ///< ends there: walls seen through from outside keep the sun out
};

struct PathOptions {
  /// The most straight parts of a path: with 1 only what shines itself is seen, with 2 what it
  /// lights directly. At least 1.
  std::uint32_t max_depth = 32;
  Backfaces backfaces = Backfaces::pass;
};

/// Light by path tracing (J. Kajiya, The rendering equation, 1986): the scene's lights, its
/// environment, and what shines, scattered by the surfaces' materials as glTF 2.0's appendix B has
/// them. The mean over the samples is the radiance but for what paths longer than max_depth bring.
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
