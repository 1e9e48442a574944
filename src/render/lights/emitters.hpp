#pragma once
/// The emissive surfaces and punctual lights of a scene.

#include "render/lanes/light_lanes.hpp"
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
  Vec3 n{0, 0, 1};  ///< unit normal on either side
};

/// Immutable; any number of threads may use it.
class Emitters {
 public:
  /// `scene` and `shading` must outlive this object.
  Emitters(const Scene& scene, const Shading& shading);

  /// True if there are lights at a finite distance: emissive surfaces, point lights or spot lights.
  [[nodiscard]] bool has_near() const { return tree_.has_value(); }
  [[nodiscard]] bool has_surfaces() const { return surfaces_ > 0; }
  /// True if there are directional lights.
  [[nodiscard]] bool has_far() const { return !far_lights_.empty(); }

  /// The input for selecting lights, without the environment.
  [[nodiscard]] LightChoiceSetup choice_setup() const;

  /// The punctual lights, by their indices in Scene::lights.
  [[nodiscard]] const PunctualLight* punctual() const { return punctual_.data(); }
  /// The index of a directional light among them. `choice`, in [0, 1), selects it.
  [[nodiscard]] std::uint32_t far_light(float choice) const;
  [[nodiscard]] std::size_t far_count() const { return far_lights_.size(); }
  /// The index of a near light among them; nothing for surfaces.
  [[nodiscard]] std::optional<std::uint32_t> punctual_index(std::uint32_t light) const {
    const std::uint32_t index = emitters_[light].light;
    return index == kNone ? std::nullopt : std::optional(index);
  }

  /// The emissive triangles of meshes.
  [[nodiscard]] const TriangleLight* triangles() const { return triangles_.data(); }
  static constexpr std::uint32_t kNone = ~0U;
  /// For each near light, the index of an untextured triangle; kNone for others.
  [[nodiscard]] const std::uint32_t* untextured_triangles() const {
    return untextured_triangles_.data();
  }
  /// The index of a near light among the triangles; nothing for other lights.
  [[nodiscard]] std::optional<std::uint32_t> triangle_index(std::uint32_t light) const {
    const Emitter& emitter = emitters_[light];
    if (emitter.light != kNone || emitter.shape != nullptr) return std::nullopt;
    return emitter.triangle;
  }
  /// Sets the emission and coverage at the point u of a triangle in a lane, if the triangle is
  /// textured.
  void put_textured(std::uint32_t triangle, const Vec2& u, int lane,
                    TriangleChoices<kShadingLanes>& choices) const;
  /// Samples an emissive surface that is not a triangle of a mesh. u selects a point on it.
  /// `probability` is the probability of selecting this light.
  [[nodiscard]] std::optional<LightSample> sample_shape(std::uint32_t light, const Vec3& p,
                                                        const Vec2& u, double probability) const;

  /// The index of an emissive surface among the lights; nothing for other primitives.
  [[nodiscard]] std::optional<std::size_t> find(PrimitiveId id) const;
  /// The pdf, per solid angle, with which light sampling returns a point of this surface at this
  /// distance from the context's point. `cosine` is the cosine of the angle to the surface normal;
  /// it must be positive.
  [[nodiscard]] float pdf(std::size_t light, const LightSampleContext& context, float distance,
                          float cosine, double probability) const;

 private:
  /// A triangle of a mesh, a single shape, or a near light of Scene::lights.
  struct Emitter {
    PrimitiveId id = 0;
    std::uint32_t light = kNone;   ///< index into Scene::lights; kNone for surfaces
    std::uint32_t triangle = 0;    ///< index into triangles_ if it is a triangle of a mesh
    double area = 0;               ///< area of a triangle of a mesh
    const Shape* shape = nullptr;  ///< the shape if it is not a mesh
  };

  void add_surfaces(std::vector<LightBounds>& bounds);
  void add_triangle(PrimitiveId id, const Triangle& t, std::vector<LightBounds>& bounds);
  void add_shape(PrimitiveId id, const Shape& shape, std::vector<LightBounds>& bounds);
  void add_lights(std::vector<LightBounds>& bounds);
  [[nodiscard]] std::optional<FoundLight> of_shape(const Emitter& emitter, const Vec3& p,
                                                   const Vec2& u) const;

  const Scene& scene_;
  const Shading& shading_;
  std::vector<std::uint32_t> far_lights_;  // indices into Scene::lights
  std::vector<Emitter> emitters_;          // emissive surfaces first, sorted by id
  std::vector<TriangleLight> triangles_;
  std::vector<std::uint32_t> untextured_triangles_;
  std::vector<PunctualLight> punctual_;  // by index in Scene::lights
  std::size_t surfaces_ = 0;
  std::optional<LightTree> tree_;  // tree of the emitters
  double far_light_ = 0;
};

}  // namespace microtrace
