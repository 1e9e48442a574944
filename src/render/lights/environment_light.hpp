#pragma once
/// The light of an environment: its radiance, and directions in which much of it comes.

#include "render/lights/map_distribution.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>

#include <memory>
#include <optional>

namespace microtrace {

/// Directions are world space, of about unit length, and lead away from what is lit. Made once for
/// a picture; any number of threads may ask.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(const Environment& environment);

  /// Linear Rec. 709, W / (sr m^2) or cd / m^2 as the environment has it.
  [[nodiscard]] Vec3 radiance(const Vec3& direction) const;

  /// The same from everywhere: sampling it has no use beside sampling the surface.
  [[nodiscard]] bool is_uniform() const { return !distribution_; }

  struct Sample {
    Vec3 wi;
    Vec3 radiance;  ///< radiance(wi), but for rounding
    float pdf;      ///< pdf(wi), above 0; where rounding moves wi over the edge of one of the map's
                    ///< pixels, that of the pixel that was chosen
  };
  /// Chooses a direction about proportionally to luminance; u in [0, 1)^2.
  [[nodiscard]] Sample sample(const Vec2& u) const;

  /// The density with which sample() gives this direction, per steradian; nowhere 0.
  [[nodiscard]] float pdf(const Vec3& direction) const;

  /// The mean of the luminance over all directions, in the unit of radiance.
  [[nodiscard]] float mean_luminance() const { return mean_luminance_; }

 private:
  struct Place {
    float x, y;  ///< in pixels of the map, within [0, width) and [0, height)
  };
  [[nodiscard]] Place place_of(const Vec3& direction) const;
  [[nodiscard]] float row_of(float axis_range, float height) const;
  [[nodiscard]] Vec3 radiance_at(Place place) const;
  [[nodiscard]] float pdf_at(Place place) const;

  Vec3 uniform_{0};
  std::shared_ptr<const RadianceMap> map_{};  ///< null: uniform_
  std::optional<MapDistribution> distribution_{};
  float width_ = 0, height_ = 0;  ///< of the map
  float intensity_;
  float turn_;       ///< added to a direction's longitude, in [0, 1)
  float back_turn_;  ///< added to u of the map for a longitude, in [0, 1)
  float mean_luminance_ = 0;
};

}  // namespace microtrace
