#pragma once
/// The built-in environment.

#include <microtrace/environment.hpp>

namespace microtrace {

/// Makes the studio: a gray map of 256 x 128 pixels, symmetric in x.
[[nodiscard]] RadianceMap make_studio();

}  // namespace microtrace
