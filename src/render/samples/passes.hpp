#pragma once
/// Renders in passes, each of which adds a few samples per pixel to the whole picture.

#include "render/samples/draw_at_random.hpp"
#include "render/samples/painters.hpp"

#include <microtrace/render.hpp>
#include <microtrace/sample_sums.hpp>

namespace microtrace {

/// Adds those samples of `wanted` that are missing to the sums, within the limits of `passes`.
/// Calls the drawing's progress function as for_each_tile does.
void run_passes(const RandomDrawing& drawing, Painters& painters, const SampleRange& wanted,
                const Passes& passes, SampleSums& sums);

}  // namespace microtrace
