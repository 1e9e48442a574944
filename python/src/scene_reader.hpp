#pragma once
#include "common.hpp"

#include <optional>

namespace microtrace::python {

/// Converts a microtrace.Scene. Throws TypeError, ValueError and Error.
Scene scene_from_python(const nb::handle& scene);

/// Converts a camera. Throws TypeError, ValueError and Error.
Camera camera_from_python(const nb::handle& camera);

/// Converts an environment; nothing for None. Throws TypeError, ValueError and Error.
std::optional<Environment> environment_from_python(const nb::handle& environment);

}  // namespace microtrace::python
