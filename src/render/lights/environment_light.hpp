#pragma once
/// The light of an environment: its radiance, and directions in which much of it comes.

#include "render/lights/map_distribution.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>
#include <microtrace/render_cache.hpp>

#include <memory>
#include <utility>

namespace microtrace {

/// A map and how it is sampled.
struct MapTables {
  std::shared_ptr<const RadianceMap> map;
  MapDistribution distribution;

  explicit MapTables(std::shared_ptr<const RadianceMap> m)
      : map(std::move(m)), distribution(*map) {}
};

/// Directions are world space, of about unit length, and lead away from what is lit. Made once for
/// a picture; any number of threads may ask.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(const Environment& environment, RenderCache* cache = nullptr);

  /// Linear Rec. 709, W / (sr m^2) or cd / m^2 as the environment has it.
  [[nodiscard]] Vec3 radiance(const Vec3& direction) const;

  /// The same from everywhere: sampling it has no use beside sampling the surface.
  [[nodiscard]] bool is_uniform() const { return !tables_; }

  struct Sample {
    Vec3 wi;
    Vec3 radiance;  ///< radiance(wi), but for rounding
    float pdf;      ///< that of wi, above 0, but for rounding of wi
  };
  /// Chooses a direction, the brighter the likelier; u in [0, 1)^2.
  [[nodiscard]] Sample sample(const Vec2& u) const;

  struct Look {
    Vec3 radiance;
    float pdf;  ///< with which sample() gives this direction, per steradian; nowhere 0
  };
  [[nodiscard]] Look look(const Vec3& direction) const;

  /// The mean of the luminance over all directions, in the unit of radiance.
  [[nodiscard]] float mean_luminance() const { return mean_luminance_; }
  /// The same of what sample() is for: what surfaces do not find as well by themselves. Of a
  /// uniform one as much as of a map that is the same all over.
  [[nodiscard]] float sampled_luminance() const { return sampled_luminance_; }

 private:
  [[nodiscard]] MapPlace place_of(const Vec3& direction, float axis_range) const;

  Vec3 uniform_{0};
  std::shared_ptr<const MapTables> tables_{};  ///< null: uniform_
  float width_ = 0, height_ = 0;               ///< of the map
  float intensity_;
  float turn_;       ///< added to a direction's longitude, in [0, 1)
  float back_turn_;  ///< added to u of the map for a longitude, in [0, 1)
  float mean_luminance_ = 0, sampled_luminance_ = 0;
};

}  // namespace microtrace
