#pragma once
#include <microtrace/math.hpp>

namespace microtrace {

/// The derivatives of a unit direction with respect to an image point.
struct LensDifferential {
  DVec3 dx, dy;
};

}  // namespace microtrace
