#pragma once
/// Powers and logarithms whose bits depend only on IEEE 754, as in trigonometry.hpp. Errors are
/// below two units in the last place; the error of a logarithm less than 1 is below 2^-52.

namespace microtrace {

/// 2^x for x in [-1000, 1000].
[[nodiscard]] double power_of_two(double x);

/// x must be a finite normal number above 0.
[[nodiscard]] double binary_logarithm(double x);

/// e^x for x <= 690, with a relative error of 2^-50 per unit of |x|; 0 below -690.
[[nodiscard]] double exponential(double x);

/// x^y for x in [0, 1] and y > 0, with the same relative error in terms of the exponent; 0 below
/// 2^-1000.
[[nodiscard]] double power(double x, double y);

}  // namespace microtrace
