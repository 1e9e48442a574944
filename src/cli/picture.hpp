#pragma once
#include "cli/arguments.hpp"
#include "cli/statistics.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <filesystem>

namespace microtrace::cli {

/// Throws the Error that stands against the pictures that the arguments ask for, before any work.
void check_outputs(const Arguments& arguments, const std::filesystem::path& output,
                   const std::filesystem::path& sidecar);

/// Draws a picture and writes it, with its sidecar if that has a name. Tells the watch.
void make_picture(const Scene& scene, const Camera& camera, ImageSize size,
                  const Arguments& arguments, const std::filesystem::path& output,
                  const std::filesystem::path& sidecar, Stopwatch& watch);

}  // namespace microtrace::cli
