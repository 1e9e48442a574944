#pragma once
/// Decides whether a triangle meets an axis-aligned box.

#include <microtrace/shape.hpp>

namespace microtrace::exact {

/// Returns true if the triangle and the closed box [lo, hi] have a point in common. All coordinates
/// must be finite, and lo at most hi. The triangle may have zero area.
[[nodiscard]] bool meets_box(const Triangle& triangle, const Vec3& lo, const Vec3& hi);

}  // namespace microtrace::exact
