#pragma once
#include <microtrace/math.hpp>

namespace microtrace {

/// Maximum radiance, which keeps products with reflectances finite. Samples are clamped to 2^46
/// anyway.
inline constexpr float kBrightest = 0x1p100F;

/// Luminance of linear Rec. 709 (ITU-R BT.709-6, item 3.2).
template <class Color>
auto luminance(const Color& c) {
  return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
}
/// luminance() in float64.
template <class Color>
auto precise_luminance(const Color& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}
inline double luminance(const DVec3& c) {
  return precise_luminance(c);
}

}  // namespace microtrace
