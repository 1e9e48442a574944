#pragma once
/// Renders the film tile by tile with samples at fixed positions.

#include "render/film/camera_rays.hpp"
#include "render/film/pixel_filter.hpp"
#include "render/film/sample_pattern.hpp"

#include <microtrace/film.hpp>
#include <microtrace/render.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace microtrace {

/// Any number of threads may paint disjoint parts of the film.
class TilePainter {
 public:
  /// All arguments must outlive this object. The film must have the pixels of `window`.
  TilePainter(const World& world, const Integrator& integrator, const RenderOptions& options,
              const PixelRect& window, Film& film);

  /// Renders a part of the window that consists of whole tiles. See DrawTile for `poll`.
  void paint(const PixelRect& part, const std::function<void()>& poll) const;

 private:
  /// Sets the pixels if all of their rays have the same sample for certain. Otherwise returns
  /// false.
  [[nodiscard]] bool fill(const PixelRect& part) const;
  void trace(const PixelRect& tile) const;
  /// Returns the sample that all rays of the part have in common, if that is certain.
  [[nodiscard]] std::optional<Sample> common_sample(const PixelRect& part) const;
  void paint_block(const PixelRect& block) const;
  /// Sets the pixel (x, y) of the whole picture.
  void set(std::uint32_t x, std::uint32_t y, const Sample& sample) const;

  const World& world_;
  const Integrator& integrator_;
  CameraRays ray_;
  const PixelRect& window_;
  Film& film_;
  std::vector<PixelOffset> pattern_;
  PixelOffset least_, greatest_;  // bounds of the pattern's coordinates
  Vec3 background_;
  std::uint32_t block_width_, block_height_;
};

}  // namespace microtrace
