#pragma once
#include "accel/build/tree.hpp"

#include <microtrace/shape.hpp>

namespace microtrace {

/// True if the quadric is an ellipsoid, a point or empty, and the box contains it. Exact.
[[nodiscard]] bool holds_ellipsoid(const Bounds& box, const Quadric& quadric);

}  // namespace microtrace
