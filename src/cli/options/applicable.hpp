#pragma once
/// Options that not all integrators can apply. Most of them need path tracing.

#include "cli/arguments.hpp"

#include <string_view>
#include <vector>

namespace microtrace::cli {

/// Throws Error (usage) if the integrator can't apply a given option. Requires choose_integrator().
void check_applicable(const Arguments& arguments);

/// Removes the options that check_applicable() refuses and returns their names.
[[nodiscard]] std::vector<std::string_view> omit_inapplicable(Arguments& arguments);

}  // namespace microtrace::cli
