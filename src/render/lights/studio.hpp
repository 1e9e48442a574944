#pragma once
/// The built-in environment.

#include <microtrace/environment.hpp>

namespace microtrace {

/// A map of 256 x 128 pixels, the same in the directions (x, y, z) and (-x, y, z), grey.
[[nodiscard]] RadianceMap make_studio();

}  // namespace microtrace
