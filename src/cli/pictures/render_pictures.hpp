#pragma once
/// The command without a name: renders the picture of a scene, or one picture for each frame.

#include "cli/arguments.hpp"

namespace microtrace::cli {

/// Reads the scene file, renders and writes its pictures. With --validate, prints the result for
/// the scene instead. Returns the exit code. Throws Error.
[[nodiscard]] int render_pictures(const Arguments& arguments);

}  // namespace microtrace::cli
