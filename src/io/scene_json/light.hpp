#pragma once
/// The lights and the environment of a JSON scene.

#include "io/json/reader.hpp"
#include "io/scene_json/color.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/io.hpp>
#include <microtrace/light.hpp>

#include <filesystem>

namespace microtrace::io {

/// Reads a member of "lights"; docs/scene-format.md tells its members. Throws Error.
[[nodiscard]] Light read_light(const JsonReader& json, const Colors& colors);

/// Reads the member "environment" and the file that it may name, sought in `folder`: adds to the
/// warnings. Throws Error, of kind io and at the member "file" if that can't be read.
[[nodiscard]] Environment read_environment(const JsonReader& json, const Colors& colors,
                                           const std::filesystem::path& folder,
                                           std::vector<Diagnostic>& warnings);

}  // namespace microtrace::io
