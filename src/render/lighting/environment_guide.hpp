#pragma once
/// Samples the light of an environment that reaches a surface.

#include "render/guiding/guide_distribution.hpp"
#include "render/guiding/lazy_cells.hpp"
#include "render/lighting/sky_visibility.hpp"
#include "render/lights/environment/environment_light.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

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
    distributions_.resize(visibility.count());
  }

  struct Cell {
    /// The probability of sampling by visibility. It is 0 if the cell sees much of the environment,
    /// or nothing of it.
    float part = 0;
    /// The factor of the environment's estimated light at a surface in this cell.
    float share = 1;
    /// The distribution of directions by visibility; null if the probability is 0.
    const GuideTable* directions = nullptr;
  };

  /// The cells' grid.
  [[nodiscard]] const SkyGrid& grid() const { return visibility_.grid(); }
  /// The cell with an index of the grid.
  [[nodiscard]] const Cell& at(std::size_t index) const {
    // Makes the cell on first use.
    (void)distributions_.get(index, [&] { return fill(index); });
    return cells_[index];
  }
  /// The cell for surfaces at p with the unit normal n.
  [[nodiscard]] const Cell& at(const Vec3& p, const Vec3& n) const {
    return at(visibility_.index(p, n));
  }

 private:
  using Distribution = std::optional<GuideDistribution>;

  /// Sets a cell and returns its distribution.
  [[nodiscard]] std::unique_ptr<const Distribution> fill(std::size_t index) const;

  const SkyVisibility& visibility_;
  const EnvironmentLight& environment_;
  mutable std::vector<Cell> cells_;  // side by side, because the fastest caches hold few of them
  LazyCells<Distribution> distributions_;  // empty where the probability is 0
};

}  // namespace microtrace
