#pragma once
/// Renders AOVs tile by tile.

#include "render/aovs/sights.hpp"
#include "render/film/camera_rays.hpp"

#include <microtrace/aov.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/render_aovs.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace microtrace {

/// Adds the channels of these quantities to the film, and returns their buffers.
[[nodiscard]] std::vector<AovBuffer> add_channels(std::span<const Aov> aovs, Film& film);

/// Any number of threads may paint disjoint tiles.
class AovPainter {
 public:
  /// The buffers must have the pixels of `window`. All arguments must outlive this object.
  AovPainter(const World& world, const Camera& camera, std::span<const AovBuffer> buffers,
             const PixelRect& window);

  /// Renders a tile of the window. The tile has at most kTileEdge pixels per side.
  void paint(const PixelRect& tile) const;

 private:
  /// Fills a tile in which nothing is visible.
  void paint_empty(const PixelRect& tile) const;

  const World& world_;
  CameraRays rays_;
  std::span<const AovBuffer> buffers_;
  AovSet aovs_;
  const PixelRect& window_;
  PixelRect occupied_;  ///< nothing is visible outside this rectangle
};

}  // namespace microtrace
