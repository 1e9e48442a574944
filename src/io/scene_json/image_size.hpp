#pragma once
/// Reads picture sizes in a JSON scene.

#include "io/json/reader.hpp"

#include <microtrace/camera.hpp>

namespace microtrace::io {

/// Reads an object with `width` and `height`. Throws Error.
[[nodiscard]] ImageSize read_image_size(const JsonReader& json);

}  // namespace microtrace::io
