#pragma once
/// `microtrace explain` tells what a ray meets and why.

#include "cli/arguments.hpp"

namespace microtrace::cli {

/// Prints the explanation of arguments.explain to standard output. Throws Error.
void explain_ray(const Arguments& arguments);

}  // namespace microtrace::cli
