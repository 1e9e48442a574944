#pragma once
/// Renders pictures by Monte Carlo integrators.

#include "render/film/tiles.hpp"

#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/render.hpp>

#include <chrono>
#include <functional>

namespace microtrace {

struct RandomDrawing {
  const World& world;
  const Integrator& integrator;
  const RenderOptions& options;
  const PixelRect& window;
  Threads& threads;
  std::chrono::steady_clock::time_point start;  ///< start of the time limit
};

/// Renders the film, which has the pixels of the window. Also calls `beside` once for each tile.
/// Throws Error of kind limit if there is not enough memory for passes, and of kind usage if the
/// given sums belong to a different picture.
void draw_at_random(const RandomDrawing& drawing, Film& film,
                    const std::function<void(const PixelRect&)>& beside);

}  // namespace microtrace
