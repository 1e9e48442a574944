#pragma once
/// The lights and the environment of a JSON scene.

#include "io/json/reader.hpp"
#include "io/scene_json/color.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/io.hpp>
#include <microtrace/light.hpp>

#include <filesystem>

namespace microtrace::io {

/// Reads a member of "lights", defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Light read_light(const JsonReader& json, const Colors& colors);

/// Reads the member "environment" and the file that it may name, relative to `folder`; appends
/// warnings. Throws Error, with kind io and at the member "file" if the file can't be read.
[[nodiscard]] Environment read_environment(const JsonReader& json, const Colors& colors,
                                           const std::filesystem::path& folder,
                                           std::vector<Diagnostic>& warnings);

}  // namespace microtrace::io
