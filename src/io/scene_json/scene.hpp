#pragma once
/// The scene format of docs/scene-format.md, version 1.

#include "io/json/document.hpp"

#include <microtrace/io.hpp>

#include <filesystem>

namespace microtrace::io {

/// Reads a scene; mesh files are sought in `folder` and nowhere above it, and posed as
/// the options say. Throws Error with the
/// place of the first thing that is wrong.
[[nodiscard]] LoadedScene read_json_scene(const JsonDocument& document,
                                          const std::filesystem::path& folder,
                                          const LoadOptions& options = {});

}  // namespace microtrace::io
