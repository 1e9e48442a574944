#pragma once
/// Reads the scene format of docs/scene-format.md, version 1.

#include "io/json/document.hpp"

#include <microtrace/io.hpp>

#include <filesystem>

namespace microtrace::io {

/// Reads a scene. Mesh files must be in `folder` or below. Their meshes are posed according to the
/// options. Throws Error at the first invalid value.
[[nodiscard]] LoadedScene read_json_scene(const JsonDocument& document,
                                          const std::filesystem::path& folder,
                                          const LoadOptions& options = {});

}  // namespace microtrace::io
