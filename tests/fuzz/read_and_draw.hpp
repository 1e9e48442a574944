#pragma once
/// What every fuzz target does with a scene file.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace::fuzz {

/// Reads the bytes as the scene file `name` in an empty folder and draws pictures of a few
/// pixels, flat and with light, of what is not too large. Only an Error may leave the reader, and
/// only with a message; anything else ends the process, as do broken promises about what was read.
void read_and_draw(std::string_view bytes, const std::string& name);

}  // namespace microtrace::fuzz
