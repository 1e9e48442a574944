#pragma once
/// All lights of a scene, and light sampling.

#include "render/lights/environment_light.hpp"
#include "render/lights/light_sample.hpp"
#include "render/lights/light_tree.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace {

/// The shading point for which light is sampled.
struct LightSampleContext {
  Vec3 p{0};
  Vec3 n{0, 0, 1};  ///< unit normal, on either side
};

/// Created once per picture; may be used by any number of threads.
class Lighting {
 public:
  /// Scene and shading must outlive this. A scene with neither lights nor an environment gets the
  /// studio.
  Lighting(const Scene& scene, const Shading& shading, RenderCache* cache = nullptr);

  /// Samples a light for a point: `choice` selects the light, u the position on it. Nothing if the
  /// selected light is not sampled: a uniform environment is left to BSDF sampling.
  [[nodiscard]] std::optional<LightSample> sample(const LightSampleContext& context, const Vec2& u,
                                                  float choice) const;

  /// Whether sample() can return light.
  [[nodiscard]] bool can_sample() const {
    return tree_ || !far_lights_.empty() || samples_environment();
  }

  /// Whether paths can hit light: the environment or emissive surfaces.
  [[nodiscard]] bool may_surround() const { return environment_ || surfaces_ > 0; }

  /// Whether the environment is visible to camera rays.
  [[nodiscard]] bool is_seen() const {
    return scene_.environment && scene_.environment->is_background;
  }

  /// Radiance from a unit direction.
  [[nodiscard]] Vec3 environment(const Vec3& wi) const {
    return environment_ ? environment_->radiance(wi) : Vec3(0);
  }
  /// The same, with the pdf with which sample() returns this direction for the context.
  [[nodiscard]] EnvironmentLight::Lookup environment(const LightSampleContext& context,
                                                     const Vec3& wi) const;

  /// The pdf with which sample() returns a point of an emissive surface, for a path that arrives
  /// there from the context after `distance`; `cosine` is between the path and the surface's
  /// normal.
  [[nodiscard]] float emitter_pdf(PrimitiveId id, const LightSampleContext& context, float distance,
                                  float cosine) const;

 private:
  static constexpr std::uint32_t kNone = ~0U;

  /// A mesh triangle, a shape, or a light of Scene::lights with a position.
  struct Emitter {
    PrimitiveId id = 0;
    std::uint32_t light = kNone;   ///< kNone: an emissive surface
    double area = 0;               ///< of a mesh triangle
    const Shape* shape = nullptr;  ///< null for mesh triangles
  };

  /// Selection probabilities at a point: of the environment, of all infinitely distant lights
  /// together, and of the tree.
  struct Probabilities {
    float environment = 0, far = 0, tree = 0;
  };
  [[nodiscard]] Probabilities probabilities(const LightSampleContext& context) const;

  void add_surfaces(std::vector<LightBounds>& bounds);
  void add_triangle(PrimitiveId id, const Triangle& t, std::vector<LightBounds>& bounds);
  void add_shape(PrimitiveId id, const Shape& shape, std::vector<LightBounds>& bounds);
  void add_lights(std::vector<LightBounds>& bounds);
  [[nodiscard]] bool samples_environment() const {
    return environment_ && !environment_->is_uniform();
  }
  /// `probability` is the probability of all infinitely distant lights, or of the tree.
  [[nodiscard]] std::optional<LightSample> of_far(const LightSampleContext& context, float choice,
                                                  double probability) const;
  [[nodiscard]] std::optional<LightSample> of_tree(const LightSampleContext& context, const Vec2& u,
                                                   float choice, double probability) const;
  [[nodiscard]] std::optional<FoundLight> of_triangle(const Emitter& emitter, const Vec3& p,
                                                      const Vec2& u) const;
  [[nodiscard]] std::optional<FoundLight> of_shape(const Emitter& emitter, const Vec3& p,
                                                   const Vec2& u) const;
  /// The emission of a point, as a sample with this pdf.
  [[nodiscard]] std::optional<FoundLight> of_point(const ShadingPoint& point, PrimitiveId id,
                                                   const DVec3& to_light, const Vec3& wi,
                                                   double pdf) const;

  const Scene& scene_;
  const Shading& shading_;
  std::optional<EnvironmentLight> environment_;
  std::vector<std::uint32_t> far_lights_;  // lights of Scene::lights without a position
  std::vector<Emitter> emitters_;          // emissive surfaces first, by id
  std::size_t surfaces_ = 0;
  std::optional<LightTree> tree_;                 // of the emitters
  double environment_light_ = 0, far_light_ = 0;  // approximate irradiance of a surface
};

}  // namespace microtrace
