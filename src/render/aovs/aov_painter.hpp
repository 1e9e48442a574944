#pragma once
/// Fills the film's AOV channels tile by tile.

#include "render/camera_rays.hpp"

#include <microtrace/aov.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace microtrace {

/// Any number of threads may paint disjoint tiles.
class AovPainter {
 public:
  /// Adds the channels to the film, which has the pixels of `window`. All arguments must outlive
  /// this object.
  AovPainter(const World& world, std::span<const Aov> aovs, const PixelRect& window, Film& film);

  /// A tile of the window, at most kTileEdge pixels per side.
  void paint(const PixelRect& tile) const;

 private:
  void set(std::size_t pixel, const Ray& ray, const std::optional<Hit>& hit) const;

  const World& world_;
  CameraRays rays_;
  std::span<const Aov> aovs_;
  const PixelRect& window_;
  Film& film_;
};

}  // namespace microtrace
