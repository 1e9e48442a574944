#pragma once
/// Samples directions above a horizontal surface.

#include "base/memory_account.hpp"
#include "render/lights/environment/environment_light.hpp"

#include <microtrace/math.hpp>

#include <cstdint>
#include <vector>

namespace microtrace {

/// Samples directions with y >= 0 in proportion to the luminance of the irradiance that an
/// environment gives a horizontal surface from them: radiance times cosine. The directions are
/// divided into cells of the size of the map's pixels. The radiance at a cell's center counts for
/// the whole cell. Within a cell, directions are in proportion to the cosine.
class HemisphereDistribution {
 public:
  explicit HemisphereDistribution(const EnvironmentLight& light);

  /// The luminance of the irradiance, in pi times the unit of radiance.
  [[nodiscard]] double irradiance() const { return row_ends_.back(); }

  /// Returns a unit direction. Requires positive irradiance(). u is in [0, 1)^2.
  [[nodiscard]] Vec3 sample(const Vec2& u) const;

 private:
  std::uint32_t columns_, rows_;
  MemoryAccount memory_;
  std::vector<float> bounds_;       ///< squares of the sines of polar angles; rows_ + 1
  std::vector<double> row_ends_;    ///< cumulative irradiance
  std::vector<float> column_ends_;  ///< cumulative distribution of each row
};

}  // namespace microtrace
