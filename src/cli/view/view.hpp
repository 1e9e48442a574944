#pragma once
#include "cli/arguments.hpp"

namespace microtrace::cli {

/// Serves a page that shows the scene until the user ends it. Throws Error.
void view_scene(const Arguments& arguments);

}  // namespace microtrace::cli
