#pragma once
/// Reads file names in a JSON scene.

#include "io/json/reader.hpp"

#include <filesystem>

namespace microtrace::io {

/// Reads a path that stays in the scene's folder. Throws Error.
[[nodiscard]] std::filesystem::path read_relative_path(const JsonReader& json);

}  // namespace microtrace::io
