#pragma once
/// The objects of a JSON scene that come from a glTF file of their own.

#include "io/json/reader.hpp"

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <filesystem>

namespace microtrace::io {

/// Reads a member of "objects" of type mesh and the glTF file that it names, sought in `folder`:
/// posed as the options say: its objects with their own names and colours, and its warnings. Throws
/// Error, of kind io and at the member "file" if that file can't be read.
[[nodiscard]] LoadedScene read_mesh(const JsonReader& json, const std::filesystem::path& folder,
                                    const LoadOptions& options);

/// Reads a member "transform": translation * rotation * scale, or a column-major affine matrix.
[[nodiscard]] DMat4 read_transform(const JsonReader& json);

}  // namespace microtrace::io
