#pragma once
/// Sine, cosine and tangent whose bits depend on IEEE 754 alone: the C library's differ between
/// versions and machines, and would move pixels. Errors stay below two units in the last place.

namespace microtrace {

/// |x| <= 2^20 radians.
[[nodiscard]] double sin_radians(double x);
[[nodiscard]] double cos_radians(double x);
[[nodiscard]] double tan_radians(double x);

/// Any finite angle; multiples of 90 degrees give exactly 0 and +-1.
[[nodiscard]] double sin_degrees(double x);
[[nodiscard]] double cos_degrees(double x);

[[nodiscard]] double radians_from_degrees(double x);

}  // namespace microtrace
