#pragma once
/// Reads the materials of a JSON scene.

#include "io/json/reader.hpp"
#include "io/scene_json/color.hpp"

#include <microtrace/material.hpp>

namespace microtrace::io {

/// Reads an item of "materials" as defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Material read_material(const JsonReader& json, const Colors& colors);

}  // namespace microtrace::io
