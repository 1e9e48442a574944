#pragma once
/// Trigonometric functions whose bits depend only on IEEE 754. The C library's results differ
/// between versions and machines and would change pixels. Errors of sine and cosine are below two
/// units in the last place, errors of the other functions below four.

namespace microtrace {

/// Require |x| <= 2^20 radians.
[[nodiscard]] double sin_radians(double x);
[[nodiscard]] double cos_radians(double x);
[[nodiscard]] double tan_radians(double x);

/// The angle in [-pi/2, pi/2] whose tangent is x. x may be infinite.
[[nodiscard]] double atan_radians(double x);

/// The angle in [-pi, pi] of the vector (x, y); 0 if both are 0.
[[nodiscard]] double atan2_radians(double y, double x);

/// Accept any finite angle. Multiples of 90 degrees give exactly 0, 1 or -1.
[[nodiscard]] double sin_degrees(double x);
[[nodiscard]] double cos_degrees(double x);

[[nodiscard]] double radians_from_degrees(double x);

}  // namespace microtrace
