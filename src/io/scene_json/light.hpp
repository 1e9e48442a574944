#pragma once
/// Reads the lights and the environment of a JSON scene.

#include "io/json/reader.hpp"
#include "io/scene_json/color.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/io.hpp>
#include <microtrace/light.hpp>

#include <filesystem>

namespace microtrace::io {

/// Reads an item of "lights" as defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Light read_light(const JsonReader& json, const Colors& colors);

/// Reads the member "environment" and the file that it may name, relative to `folder`. Appends
/// warnings. Throws Error. If the file can't be read, the error has kind io and points to the
/// member "file".
[[nodiscard]] Environment read_environment(const JsonReader& json, const Colors& colors,
                                           const std::filesystem::path& folder,
                                           std::vector<Diagnostic>& warnings);

}  // namespace microtrace::io
