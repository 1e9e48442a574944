#pragma once
/// Reads the cameras of a JSON scene.

#include "io/json/reader.hpp"

#include <microtrace/camera.hpp>

namespace microtrace::io {

/// Reads an item of "cameras" as defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Camera read_camera(const JsonReader& json);

}  // namespace microtrace::io
