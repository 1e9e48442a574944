#pragma once
#include "render/film/tiles.hpp"
#include "render/guiding/path_guide.hpp"

#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/path.hpp>

#include <functional>
#include <memory>

namespace microtrace {

/// Traces paths through a picture of this size and returns what they learned. The result depends
/// on the scene, the camera, the seed, the size and the options, not on the number of threads.
/// `progress` is as in for_each_tile().
[[nodiscard]] std::unique_ptr<const PathGuide> train_guide(
    const World& world, const PathOptions& options, ImageSize size, Threads& threads,
    const std::function<bool(double)>& progress);

}  // namespace microtrace
