#pragma once
/// Shapes defined in the JSON scene itself.

#include "io/json/reader.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::io {

/// Reads a member of "objects" that is not a mesh, defined in docs/scene-format.md. Throws Error.
[[nodiscard]] Shape read_shape(const JsonReader& json);

}  // namespace microtrace::io
