#pragma once
#include <microtrace/scene.hpp>

namespace microtrace {

/// The first two rules of validate() (microtrace/validate.hpp): those that keep a program from
/// undefined behavior. Throws Error (invalid_scene).
void check_indices(const Scene& scene);

}  // namespace microtrace
