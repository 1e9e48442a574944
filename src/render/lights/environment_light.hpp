#pragma once
/// Environment lights: radiance, and sampling of directions.

#include "render/lights/map_distribution.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>
#include <microtrace/render_cache.hpp>

#include <memory>
#include <utility>

namespace microtrace {

/// A map and its sampling distribution.
struct MapTables {
  std::shared_ptr<const RadianceMap> map;
  MapDistribution distribution;

  explicit MapTables(std::shared_ptr<const RadianceMap> m)
      : map(std::move(m)), distribution(*map) {}
};

/// Directions are in world space, of approximately unit length, and point away from the shading
/// point. Created once per picture; may be used by any number of threads.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(const Environment& environment, RenderCache* cache = nullptr);

  /// Linear Rec. 709, in the environment's unit: W / (sr m^2) or cd / m^2.
  [[nodiscard]] Vec3 radiance(const Vec3& direction) const;

  /// Uniform radiance: BSDF sampling is at least as good as sampling the environment.
  [[nodiscard]] bool is_uniform() const { return !tables_; }

  struct Sample {
    Vec3 wi;
    Vec3 radiance;  ///< radiance(wi), except for rounding
    float pdf;      ///< pdf of wi, above 0, except for rounding of wi
  };
  /// Samples a direction in proportion to its radiance, approximately; u in [0, 1)^2.
  [[nodiscard]] Sample sample(const Vec2& u) const;

  struct Lookup {
    Vec3 radiance;
    float pdf;  ///< of sample(), per steradian; never 0
  };
  [[nodiscard]] Lookup lookup(const Vec3& direction) const;

  /// The mean luminance over all directions, in the unit of radiance.
  [[nodiscard]] float mean_luminance() const { return mean_luminance_; }
  /// The mean of the part of the luminance that sample() covers, which is what BSDF sampling does
  /// not find as well. A uniform environment has the value of a constant map.
  [[nodiscard]] float sampled_luminance() const { return sampled_luminance_; }

 private:
  [[nodiscard]] MapPlace place_of(const Vec3& direction, float axis_range) const;

  Vec3 uniform_{0};
  std::shared_ptr<const MapTables> tables_{};  ///< null: uniform_
  float width_ = 0, height_ = 0;               ///< size of the map
  float intensity_;
  float turn_;       ///< added to a direction's longitude, in [0, 1)
  float back_turn_;  ///< added to u of the map for a longitude, in [0, 1)
  float mean_luminance_ = 0, sampled_luminance_ = 0;
};

}  // namespace microtrace
