#pragma once
/// A term from which the hits of discs are decided.

#include "exact/numbers/vector.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::exact {

/// Returns the squared distance from the disc's center to the point where the ray's line crosses
/// the disc's plane, multiplied by speed^2. The crossing is at t = distance / speed, where speed =
/// n.d is not zero.
[[nodiscard]] Dyadic squared_offset(const Disc& disc, const Ray& ray, const Dyadic& distance,
                                    const Dyadic& speed);

}  // namespace microtrace::exact
