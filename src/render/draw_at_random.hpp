#pragma once
/// Pictures by integrators whose answers are random.

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
  std::chrono::steady_clock::time_point start;  ///< from which a time limit counts
};

/// Fills the film, which holds the pixels of the window, and calls `beside` once for each tile.
/// Throws Error: limit where memory for passes runs out, usage where their sums are another
/// picture's.
void draw_at_random(const RandomDrawing& drawing, Film& film,
                    const std::function<void(const PixelRect&)>& beside);

}  // namespace microtrace
