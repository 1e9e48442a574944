#pragma once
/// Samples the light of an environment that reaches a surface.

#include "render/guiding/guide_distribution.hpp"
#include "render/guiding/lazy_cells.hpp"
#include "render/guiding/sky_visibility.hpp"
#include "render/lights/environment_light.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <memory>
#include <optional>

namespace microtrace {

/// For each cell of a SkyVisibility, a pdf of directions in proportion to the environment's
/// luminance that arrives, times about the cosine. It is combined with the environment's own pdf,
/// which is independent of visibility, because the cells are coarse. Any number of threads may use
/// the object.
class EnvironmentGuide {
 public:
  /// The arguments must outlive this object.
  EnvironmentGuide(const SkyVisibility& visibility, const EnvironmentLight& environment)
      : visibility_(visibility), environment_(environment) {
    cells_.resize(visibility.count());
  }

  class Cell {
   public:
    /// The probability of sampling by visibility. It is 0 if the cell sees much of the environment,
    /// or nothing of it.
    [[nodiscard]] float part() const { return part_; }
    /// The fraction of a uniform environment's irradiance that arrives, at most 1.
    [[nodiscard]] float openness() const { return openness_; }

    /// The distribution of directions by visibility. part() must not be 0.
    [[nodiscard]] const GuideTable& directions() const { return directions_->table(); }

   private:
    friend class EnvironmentGuide;
    float part_ = 0, openness_ = 1;
    std::optional<GuideDistribution> directions_{};
  };

  /// The cells' grid.
  [[nodiscard]] const SkyGrid& grid() const { return visibility_.grid(); }
  /// The cell with an index of the grid.
  [[nodiscard]] const Cell& at(std::size_t index) const {
    return cells_.get(index, [&] { return fill(index); });
  }
  /// The cell for surfaces at p with the unit normal n.
  [[nodiscard]] const Cell& at(const Vec3& p, const Vec3& n) const {
    return at(visibility_.index(p, n));
  }

 private:
  [[nodiscard]] std::unique_ptr<const Cell> fill(std::size_t index) const;

  const SkyVisibility& visibility_;
  const EnvironmentLight& environment_;
  LazyCells<Cell> cells_;
};

}  // namespace microtrace
