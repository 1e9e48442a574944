#pragma once
/// Pictures by Monte Carlo integrators.

#include "render/tiles.hpp"

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

/// Fills the film, which has the pixels of the window, and calls `beside` once for each tile.
/// Throws Error: limit if memory for passes runs out, usage if the given sums belong to another
/// picture.
void draw_at_random(const RandomDrawing& drawing, Film& film,
                    const std::function<void(const PixelRect&)>& beside);

}  // namespace microtrace
