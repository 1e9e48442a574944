#pragma once
/// All that shines in a scene, and which of it a point should ask.

#include "render/lights/environment_light.hpp"
#include "render/lights/light_sample.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace microtrace {

/// Made once for a picture; any number of threads may ask it.
class Lighting {
 public:
  /// All must outlive this. A scene with neither lights nor an environment gets the studio.
  Lighting(const Scene& scene, const Primitives& primitives, const Shading& shading);

  /// Light chosen at random: `choice` says which, u where on it. Nothing if there is none to be
  /// chosen: what a uniform environment sends is found as soon by paths that meet it.
  [[nodiscard]] std::optional<LightSample> sample(const Vec3& p, const Vec2& u, float choice) const;

  /// Whether sample() ever finds light.
  [[nodiscard]] bool can_sample() const { return environment_share_ > 0 || !emitters_.empty(); }

  /// Whether camera rays see the environment.
  [[nodiscard]] bool is_seen() const {
    return scene_.environment && scene_.environment->is_background;
  }

  /// From that direction, unit length.
  [[nodiscard]] Vec3 environment(const Vec3& wi) const {
    return environment_ ? environment_->radiance(wi) : Vec3(0);
  }
  /// The density with which sample() gives that direction of the environment.
  [[nodiscard]] float environment_density(const Vec3& wi) const;

  /// The same of a point of a triangle that shines, for a path that came to it over `distance`;
  /// `cosine` is that of the angle between the path and the triangle's normal.
  [[nodiscard]] float emitter_density(PrimitiveId id, float distance, float cosine) const;

 private:
  /// A triangle, or a light of Scene::lights.
  struct Emitter {
    PrimitiveId id;
    std::uint32_t light;  ///< kNone: a triangle
    float area;
  };
  static constexpr std::uint32_t kNone = ~0U;

  void add_triangles(const Shading& shading);
  void add_lights();
  [[nodiscard]] float share(std::size_t emitter) const;
  [[nodiscard]] std::optional<LightSample> of_triangle(const Emitter& emitter, const Vec3& p,
                                                       const Vec2& u) const;

  const Scene& scene_;
  const Primitives& primitives_;
  const Shading& shading_;
  std::optional<EnvironmentLight> environment_;
  float environment_share_ = 0;    // of samples
  std::vector<Emitter> emitters_;  // triangles first, by id
  std::size_t triangles_ = 0;
  std::vector<float> powers_;
  std::vector<float> sums_;  // of the powers up to and with each, over all
};

}  // namespace microtrace
