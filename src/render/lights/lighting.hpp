#pragma once
/// All that shines in a scene, and which of it a point should ask.

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

/// What light falls on.
struct Receiver {
  Vec3 p{0};
  Vec3 n{0, 0, 1};  ///< unit normal, on either side
};

/// Made once for a picture; any number of threads may ask it.
class Lighting {
 public:
  /// Scene and shading must outlive this. A scene with neither lights nor an environment gets the
  /// studio.
  Lighting(const Scene& scene, const Shading& shading, RenderCache* cache = nullptr);

  /// Light chosen at random for a point: `choice` says which, u where on it. Nothing if there is
  /// none to be chosen: what a uniform environment sends is found as soon by paths that meet it.
  [[nodiscard]] std::optional<LightSample> sample(const Receiver& receiver, const Vec2& u,
                                                  float choice) const;

  /// Whether sample() ever finds light.
  [[nodiscard]] bool can_sample() const {
    return tree_ || !far_lights_.empty() || samples_environment();
  }

  /// Whether paths ever meet light: an environment or surfaces.
  [[nodiscard]] bool may_surround() const { return environment_ || surfaces_ > 0; }

  /// Whether camera rays see the environment.
  [[nodiscard]] bool is_seen() const {
    return scene_.environment && scene_.environment->is_background;
  }

  /// From that direction, unit length.
  [[nodiscard]] Vec3 environment(const Vec3& wi) const {
    return environment_ ? environment_->radiance(wi) : Vec3(0);
  }
  /// The same, with the density with which sample() gives that direction of the environment at the
  /// receiver.
  [[nodiscard]] EnvironmentLight::Look environment(const Receiver& receiver, const Vec3& wi) const;

  /// The same of a point of a surface that shines, for a path that came to it from the receiver
  /// over `distance`; `cosine` is that of the angle between the path and the surface's normal.
  [[nodiscard]] float emitter_density(PrimitiveId id, const Receiver& receiver, float distance,
                                      float cosine) const;

 private:
  static constexpr std::uint32_t kNone = ~0U;

  /// A mesh's triangle, a shape of its own, or a light of Scene::lights with a place.
  struct Emitter {
    PrimitiveId id = 0;
    std::uint32_t light = kNone;   ///< kNone: a surface
    double area = 0;               ///< of a mesh's triangle
    const Shape* shape = nullptr;  ///< of its own
  };

  /// Of samples at a place: the environment's, that of all far lights together, the tree's.
  struct Shares {
    float environment = 0, far = 0, tree = 0;
  };
  [[nodiscard]] Shares shares(const Receiver& receiver) const;

  void add_surfaces(std::vector<LightBounds>& bounds);
  void add_triangle(PrimitiveId id, const Triangle& t, std::vector<LightBounds>& bounds);
  void add_shape(PrimitiveId id, const Shape& shape, std::vector<LightBounds>& bounds);
  void add_lights(std::vector<LightBounds>& bounds);
  [[nodiscard]] bool samples_environment() const {
    return environment_ && !environment_->is_uniform();
  }
  /// `share` is that of all far lights, or of the tree.
  [[nodiscard]] std::optional<LightSample> of_far(const Receiver& receiver, float choice,
                                                  double share) const;
  [[nodiscard]] std::optional<LightSample> of_tree(const Receiver& receiver, const Vec2& u,
                                                   float choice, double share) const;
  [[nodiscard]] std::optional<FoundLight> of_triangle(const Emitter& emitter, const Vec3& p,
                                                      const Vec2& u) const;
  [[nodiscard]] std::optional<FoundLight> of_shape(const Emitter& emitter, const Vec3& p,
                                                   const Vec2& u) const;
  /// What comes from a point, as a sample of that density.
  [[nodiscard]] std::optional<FoundLight> of_point(const ShadingPoint& point, PrimitiveId id,
                                                   const DVec3& way, const Vec3& wi,
                                                   double density) const;

  const Scene& scene_;
  const Shading& shading_;
  std::optional<EnvironmentLight> environment_;
  std::vector<std::uint32_t> far_lights_;  // of Scene::lights those without a place
  std::vector<Emitter> emitters_;          // surfaces first, by id
  std::size_t surfaces_ = 0;
  std::optional<LightTree> tree_;                 // of the emitters
  double environment_light_ = 0, far_light_ = 0;  // about what falls on a surface
};

}  // namespace microtrace
