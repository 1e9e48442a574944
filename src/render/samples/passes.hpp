#pragma once
/// Rendering in passes that add a few samples per pixel to the whole picture.

#include "render/samples/random_painter.hpp"
#include "render/tiles.hpp"

#include <microtrace/render.hpp>
#include <microtrace/sample_sums.hpp>

#include <chrono>
#include <cstdint>
#include <functional>

namespace microtrace {

/// Adds the missing samples of `wanted` to the sums, with the limits of `passes`; time limits count
/// from `start`. `progress` is called as by for_each_tile.
void run_passes(const RandomPainter& painter, const SampleRange& wanted, const Passes& passes,
                std::chrono::steady_clock::time_point start, Threads& threads,
                const std::function<bool(double)>& progress, SampleSums& sums);

}  // namespace microtrace
