#pragma once
/// Reads shapes that are defined in the JSON scene itself.

#include "io/json/reader.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::io {

/// Reads an item of "objects" that is not a mesh, as defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Shape read_shape(const JsonReader& json);

}  // namespace microtrace::io
