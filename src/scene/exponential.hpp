#pragma once
/// Powers and logarithms, whose bits depend on IEEE 754 alone, as those of
/// trigonometry.hpp do. Errors stay below two units in the last place, those of the logarithm below
/// 2^-52 where it is less than 1.

namespace microtrace {

/// 2^x for x in [-1000, 1000].
[[nodiscard]] double power_of_two(double x);

/// x is a finite normal number above 0.
[[nodiscard]] double binary_logarithm(double x);

/// e^x for x <= 690, to 2^-50 of it for each unit of |x|; 0 below -690.
[[nodiscard]] double exponential(double x);

/// x^y for x in [0, 1] and y > 0, likewise by the exponent's size; 0 below 2^-1000.
[[nodiscard]] double power(double x, double y);

}  // namespace microtrace
