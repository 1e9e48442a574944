#pragma once
#include <microtrace/scene.hpp>

namespace microtrace {

/// Checks the first two rules of validate() (microtrace/validate.hpp), whose violation would cause
/// undefined behavior. Throws Error (invalid_scene).
void check_indices(const Scene& scene);

/// Checks all rules of an environment, as validate() does, except for the pixels of a map that is
/// known to be valid. To check those of a large map takes longer than to render a small picture.
/// Throws Error (invalid_scene).
void check_environment(const Environment& environment, const RadianceMap* valid_map = nullptr);

}  // namespace microtrace
