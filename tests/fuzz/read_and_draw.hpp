#pragma once
/// Reads and renders scene files. All fuzz targets share this code.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace::fuzz {

/// Reads the bytes as the scene file `name` in an empty folder. Unless the scene is too large,
/// renders pictures of a few pixels, both flat and path traced. The reader may only throw Error
/// with a message. Other exceptions and broken invariants of the result abort the process.
void read_and_draw(std::string_view bytes, const std::string& name);

}  // namespace microtrace::fuzz
