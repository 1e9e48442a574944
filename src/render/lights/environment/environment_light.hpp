#pragma once
/// Environment lights: lookup of radiance, and sampling of directions.

#include "base/memory_account.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/lights/environment/map_distribution.hpp"
#include "simd/vector_types.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>

#include <memory>
#include <utility>

namespace microtrace {

/// A radiance map with its sampling tables.
struct MapTables {
  std::shared_ptr<const RadianceMap> map;
  MemoryAccount memory;  ///< memory of the tables, which several scenes may share
  MapDistribution distribution;

  MapTables(std::shared_ptr<const RadianceMap> m, MemoryAccount account)
      : map(std::move(m)), memory(std::move(account)), distribution(*map) {}
};

/// The tables of an environment's map; null for a uniform environment.
[[nodiscard]] std::shared_ptr<const MapTables> tables_of(const Environment& environment);

/// The light from an environment. Directions are in world space, have approximately unit length,
/// and point away from the surface. Any number of threads may use the object.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(const Environment& environment)
      : EnvironmentLight(environment, tables_of(environment)) {}
  /// `tables` must be tables_of(environment).
  EnvironmentLight(const Environment& environment, std::shared_ptr<const MapTables> tables);

  /// The radiance from a direction in linear Rec. 709, in the environment's unit: W / (sr m^2) or
  /// cd / m^2.
  [[nodiscard]] Vec3 radiance(const Vec3& direction) const;

  /// True if the radiance is uniform. BSDF sampling is then at least as good as sampling the
  /// environment.
  [[nodiscard]] bool is_uniform() const { return !tables_; }

  /// The size of the map in pixels; 1 x 1 for a uniform environment.
  [[nodiscard]] ImageSize map_size() const;

  /// Samples directions approximately in proportion to their radiance in these lanes. u is in [0,
  /// 1)^2. Sets d; the radiance, which equals that of d except for rounding; and the positive pdf
  /// of the unrounded d.
  void sample(Lanes lanes, const LaneFloats (&u)[2], MapLanes<kShadingLanes>& samples) const;

  struct Lookup {
    Vec3 radiance;
    float pdf;  ///< pdf of sample(), per steradian; never 0
  };
  [[nodiscard]] Lookup lookup(const Vec3& direction) const;
  /// Sets the radiance and the pdf of the directions in these lanes.
  void look_up(Lanes lanes, MapLanes<kShadingLanes>& at) const;

  /// The mean luminance over all directions, in the unit of radiance().
  [[nodiscard]] float mean_luminance() const { return mean_luminance_; }
  /// The mean luminance of the part of the light that sample() is meant for. BSDF sampling finds
  /// the rest equally well. For a uniform environment, this is the value that a constant map would
  /// have.
  [[nodiscard]] float sampled_luminance() const { return sampled_luminance_; }

 private:
  /// Sets the radiance and the pdf of any direction of a uniform environment.
  void put_uniform(MapLanes<kShadingLanes>& lanes) const;

  Vec3 uniform_{0};
  std::shared_ptr<const MapTables> tables_{};  ///< null if the radiance is uniform_
  const ShadingKernels* kernels_;
  MapShape shape_{};
  float mean_luminance_ = 0, sampled_luminance_ = 0;
};

}  // namespace microtrace
