#pragma once
/// Reading and rendering of scene files, shared by all fuzz targets.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace::fuzz {

/// Reads the bytes as the scene file `name` in an empty folder, and renders pictures of a few
/// pixels, flat and path traced, unless the scene is too large. The reader may only throw Error,
/// and only with a message. Other exceptions and broken invariants of the result abort the process.
void read_and_draw(std::string_view bytes, const std::string& name);

}  // namespace microtrace::fuzz
