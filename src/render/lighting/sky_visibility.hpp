#pragma once
/// Where enclosed scenes are open to their environment, for example through windows.

#include "render/guiding/hemisphere_bins.hpp"
#include "render/guiding/lazy_cells.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace microtrace {

/// The directions from which the environment's light arrives, for each cell of a grid and each
/// SignedAxis toward which the surfaces in the cell face. A cell is filled on first use and depends
/// only on the scene, so the result is the same for any number of threads. Any number of threads
/// may use the object.
class SkyVisibility {
 public:
  /// The fraction of light that arrives from each of HemisphereBins, in units of 1/255.
  struct Cell {
    SignedAxis about{};
    std::array<std::uint8_t, HemisphereBins::kCount> bins{};
  };

  /// The arguments must outlive this object. `bvh` and `shading` are those of the scene.
  SkyVisibility(const Scene& scene, const Bvh& bvh, const Shading& shading);

  /// True if most of the space within the scene's bounds sees little of the environment. Otherwise,
  /// sampling by visibility gains too little.
  [[nodiscard]] bool is_enclosed() const { return is_enclosed_; }

  [[nodiscard]] std::size_t count() const { return cells_.count(); }
  /// The cells' grid, by which kernels find indices.
  [[nodiscard]] const SkyGrid& grid() const { return grid_; }
  /// The index of the cell for surfaces at p with the unit normal n.
  [[nodiscard]] std::size_t index(const Vec3& p, const Vec3& n) const;
  [[nodiscard]] const Cell& cell(std::size_t index) const;

 private:
  struct Start;
  class Probe;

  /// True if the bounds are within the kernels' limits.
  [[nodiscard]] bool is_near() const;
  [[nodiscard]] bool finds_enclosed() const;
  [[nodiscard]] std::unique_ptr<const Cell> fill(std::size_t index) const;
  /// Points slightly above the cell's surfaces. Their rays only guide the sampling, so they don't
  /// need exact origins.
  [[nodiscard]] std::vector<Start> starts(std::size_t index, const SignedAxis& about) const;
  /// The fraction of the environment's light that arrives along a ray with this nearest hit.
  [[nodiscard]] float light_along(const Ray& ray, const std::optional<Hit>& hit) const;

  const Bvh& bvh_;
  const Shading& shading_;
  DVec3 low_{0}, high_{0};
  SkyGrid grid_{};
  bool is_enclosed_ = false;
  LazyCells<Cell> cells_;
};

}  // namespace microtrace
