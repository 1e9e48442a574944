#pragma once
/// Reads the cameras of a JSON scene.

#include "io/json/reader.hpp"

#include <microtrace/camera.hpp>

namespace microtrace::io {

/// Reads an item of "cameras" as defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Camera read_camera(const JsonReader& json);

/// Returns what prevents the matrix of a rigid transform from being one, apart from its last row;
/// null if nothing does.
[[nodiscard]] const char* broken_rotation(const DMat4& transform);

}  // namespace microtrace::io
