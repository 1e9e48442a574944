#pragma once
/// Samples that come a few at a time over the whole picture.

#include "render/random_painter.hpp"
#include "render/tiles.hpp"

#include <microtrace/render.hpp>
#include <microtrace/sample_sums.hpp>

#include <chrono>
#include <cstdint>
#include <functional>

namespace microtrace {

/// Adds to the sums those samples of `wanted` that are not there, as `passes` says, from which time
/// is counted since `start`. `progress` is told as by for_each_tile.
void run_passes(const RandomPainter& painter, const SampleRange& wanted, const Passes& passes,
                std::chrono::steady_clock::time_point start, Threads& threads,
                const std::function<bool(double)>& progress, SampleSums& sums);

}  // namespace microtrace
