#pragma once
/// Tone mapping.

#include <microtrace/math.hpp>
#include <microtrace/tone_map.hpp>

namespace microtrace {

/// Linear Rec. 709 on both sides. ToneMap::none returns the color unchanged; the others return a
/// color in [0, 1] for any input: negative numbers and NaN count as 0, values above 1e6 as 1e6.
[[nodiscard]] Vec3 tone_mapped(const Vec3& color, ToneMap map);

}  // namespace microtrace
