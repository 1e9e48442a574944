#pragma once
/// The shapes of a JSON scene that are written out in it.

#include "io/json/reader.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::io {

/// Reads a member of "objects" that is not a mesh; docs/scene-format.md tells its members. Throws
/// Error.
[[nodiscard]] Shape read_shape(const JsonReader& json);

}  // namespace microtrace::io
