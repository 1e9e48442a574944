#pragma once
/// The lines that --verbose prints.

#include "cli/arguments.hpp"

#include <microtrace/scene.hpp>

namespace microtrace::cli {

/// Prints to standard error what the scene contains and how it will be rendered, in lines that
/// start with "info: ".
void print_scene_summary(const Arguments& arguments, const Scene& scene, ImageSize size);

}  // namespace microtrace::cli
