#pragma once
/// What --verbose tells, on standard error, each line after "info: ".

#include "cli/arguments.hpp"

#include <microtrace/scene.hpp>

namespace microtrace::cli {

/// What was read, and how it is about to be drawn.
void tell_of_scene(const Arguments& arguments, const Scene& scene, ImageSize size);

}  // namespace microtrace::cli
