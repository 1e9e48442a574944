#pragma once
/// Renders in passes, each of which adds a few samples per pixel to the whole picture.

#include "render/samples/painters.hpp"
#include "render/tiles.hpp"

#include <microtrace/render.hpp>
#include <microtrace/sample_sums.hpp>

#include <chrono>
#include <cstdint>
#include <functional>

namespace microtrace {

/// Adds those samples of `wanted` that are missing to the sums, within the limits of `passes`. Time
/// limits count from `start`. Calls `progress` as for_each_tile does.
void run_passes(Painters& painters, const SampleRange& wanted, const Passes& passes,
                std::chrono::steady_clock::time_point start, Threads& threads,
                const std::function<bool(double)>& progress, SampleSums& sums);

}  // namespace microtrace
