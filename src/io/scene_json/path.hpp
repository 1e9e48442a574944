#pragma once
/// Names of files that a JSON scene refers to.

#include "io/json/reader.hpp"

#include <filesystem>

namespace microtrace::io {

/// A path within the scene's folder. Throws Error.
[[nodiscard]] std::filesystem::path read_relative_path(const JsonReader& json);

}  // namespace microtrace::io
