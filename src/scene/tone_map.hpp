#pragma once
/// Colours as a screen can show them.

#include <microtrace/math.hpp>
#include <microtrace/tone_map.hpp>

namespace microtrace {

/// Linear Rec. 709 on both sides. ToneMap::none gives the colour itself; others a colour in [0, 1],
/// whatever comes: negative numbers and NaN count as 0, all above 1e6 as 1e6.
[[nodiscard]] Vec3 tone_mapped(const Vec3& color, ToneMap map);

}  // namespace microtrace
