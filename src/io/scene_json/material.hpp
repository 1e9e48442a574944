#pragma once
/// The materials of a JSON scene.

#include "io/json/reader.hpp"
#include "io/scene_json/color.hpp"

#include <microtrace/material.hpp>

namespace microtrace::io {

/// Reads a member of "materials", defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Material read_material(const JsonReader& json, const Colors& colors);

}  // namespace microtrace::io
