#pragma once
#include "common.hpp"

#include <optional>

namespace microtrace::python {

/// From microtrace.Scene. Throws TypeError, ValueError and Error.
Scene scene_from_python(const nb::handle& scene);

/// Throws TypeError, ValueError and Error.
Camera camera_from_python(const nb::handle& camera);

/// None gives nothing. Throws TypeError, ValueError and Error.
std::optional<Environment> environment_from_python(const nb::handle& environment);

}  // namespace microtrace::python
