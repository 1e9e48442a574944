#pragma once
/// The light sources of a scene other than its environment: emissive surfaces, punctual lights.

#include "render/lights/light_sample.hpp"
#include "render/lights/light_tree.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace {

/// The shading point for which light is sampled.
struct LightSampleContext {
  Vec3 p{0};
  Vec3 n{0, 0, 1};  ///< unit normal, on either side
};

/// Immutable; any number of threads may use it.
class Emitters {
 public:
  /// Scene and shading must outlive this.
  Emitters(const Scene& scene, const Shading& shading);

  /// Lights at a finite distance: surfaces, point lights and spots.
  [[nodiscard]] bool has_near() const { return tree_.has_value(); }
  [[nodiscard]] bool has_surfaces() const { return surfaces_ > 0; }
  /// Directional lights.
  [[nodiscard]] bool has_far() const { return !far_lights_.empty(); }

  /// Upper estimates of the irradiance at a point, for choosing among kinds of lights.
  [[nodiscard]] double near_light(const LightSampleContext& context) const {
    return tree_ ? tree_->importance(context.p, context.n) : 0;
  }
  [[nodiscard]] double far_light() const { return far_light_; }

  /// A sample of the far lights; `choice` in [0, 1), `probability` that of sampling them at all.
  [[nodiscard]] std::optional<LightSample> sample_far(const LightSampleContext& context,
                                                      float choice, double probability) const;
  /// The same of the near lights: `choice` selects one of them, u a point on it.
  [[nodiscard]] std::optional<LightSample> sample_near(const LightSampleContext& context,
                                                       const Vec2& u, float choice,
                                                       double probability) const;
  /// The place of an emissive surface among the lights; nothing for other primitives.
  [[nodiscard]] std::optional<std::size_t> find(PrimitiveId id) const;
  /// The pdf by solid angle with which sample_near() yields a point of that surface, at that
  /// distance from the context's point; `cosine`, above 0, is that of the angle to its normal.
  [[nodiscard]] float pdf(std::size_t light, const LightSampleContext& context, float distance,
                          float cosine, double probability) const;

 private:
  static constexpr std::uint32_t kNone = ~0U;

  /// A mesh's triangle, a shape of its own, or a near light of Scene::lights.
  struct Emitter {
    PrimitiveId id = 0;
    std::uint32_t light = kNone;   ///< kNone: a surface
    double area = 0;               ///< of a mesh's triangle
    const Shape* shape = nullptr;  ///< of its own
  };

  void add_surfaces(std::vector<LightBounds>& bounds);
  void add_triangle(PrimitiveId id, const Triangle& t, std::vector<LightBounds>& bounds);
  void add_shape(PrimitiveId id, const Shape& shape, std::vector<LightBounds>& bounds);
  void add_lights(std::vector<LightBounds>& bounds);
  [[nodiscard]] std::optional<FoundLight> of_triangle(const Emitter& emitter, const Vec3& p,
                                                      const Vec2& u) const;
  [[nodiscard]] std::optional<FoundLight> of_shape(const Emitter& emitter, const Vec3& p,
                                                   const Vec2& u) const;
  /// The light of a surface point, as a sample of that pdf.
  [[nodiscard]] std::optional<FoundLight> of_point(const ShadingPoint& point, PrimitiveId id,
                                                   const DVec3& to_light, const Vec3& wi,
                                                   double pdf) const;

  const Scene& scene_;
  const Shading& shading_;
  std::vector<std::uint32_t> far_lights_;  // indices into Scene::lights
  std::vector<Emitter> emitters_;          // surfaces first, by id
  std::size_t surfaces_ = 0;
  std::optional<LightTree> tree_;  // of the emitters
  double far_light_ = 0;
};

}  // namespace microtrace
