#pragma once
#include <microtrace/scene.hpp>

namespace microtrace {

/// Checks the first two rules of validate() (microtrace/validate.hpp), whose violation would cause
/// undefined behavior. Throws Error (invalid_scene).
void check_indices(const Scene& scene);

/// Checks all rules of an environment, as validate() does. Throws Error (invalid_scene).
void check_environment(const Environment& environment);

}  // namespace microtrace
