#pragma once
/// Options that not all integrators can apply. Most of them need path tracing.

#include "cli/arguments.hpp"

#include <string>
#include <vector>

namespace microtrace::cli {

/// Throws Error (usage) if the integrator can't apply a given option. Requires choose_integrator().
void check_applicable(const Arguments& arguments);

/// Removes what check_applicable() refuses and returns it: names of options, or an option and its
/// removed values, as in "--aov variance,noisy".
[[nodiscard]] std::vector<std::string> omit_inapplicable(Arguments& arguments);

}  // namespace microtrace::cli
