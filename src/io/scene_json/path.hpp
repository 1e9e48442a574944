#pragma once
/// File names in a JSON scene.

#include "io/json/reader.hpp"

#include <filesystem>

namespace microtrace::io {

/// A path inside the scene's folder. Throws Error.
[[nodiscard]] std::filesystem::path read_relative_path(const JsonReader& json);

}  // namespace microtrace::io
