#pragma once
/// Tone mapping.

#include <microtrace/math.hpp>
#include <microtrace/tone_map.hpp>

namespace microtrace {

/// Maps a linear Rec. 709 color to another. ToneMap::none returns the color unchanged. The other
/// tone maps return a color in [0, 1] for any input. They treat negative numbers and NaN as 0, and
/// values above 1e6 as 1e6.
[[nodiscard]] Vec3 tone_mapped(const Vec3& color, ToneMap map);

}  // namespace microtrace
