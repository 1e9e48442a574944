#pragma once
/// The lines of --verbose.

#include "cli/arguments.hpp"

#include <microtrace/scene.hpp>

namespace microtrace::cli {

/// Prints what was read and how it will be rendered to standard error, in lines that start with
/// "info: ".
void print_scene_summary(const Arguments& arguments, const Scene& scene, ImageSize size);

}  // namespace microtrace::cli
