#pragma once
#include "common.hpp"

namespace microtrace::python {

/// Returns the arguments for constructing a microtrace.Scene. Arrays are shared.
nb::dict scene_to_python(const Scene& scene, bool is_flat, bool has_background);

nb::object camera_to_python(const Camera& camera, const std::string& name);

}  // namespace microtrace::python
