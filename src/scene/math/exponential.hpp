#pragma once
/// Powers and logarithms whose bits depend only on IEEE 754, for the reasons given in
/// trigonometry.hpp. Errors are below two units in the last place unless noted. Logarithms whose
/// magnitude is less than 1 have an absolute error below 2^-52.

namespace microtrace {

/// 2^x for x in [-1000, 1000].
[[nodiscard]] double power_of_two(double x);

/// The binary logarithm of x, which must be a positive, finite, normal number.
[[nodiscard]] double binary_logarithm(double x);

/// e^x for x <= 690; 0 for x below -690. The relative error is up to 2^-50 for each unit of |x|.
[[nodiscard]] double exponential(double x);

/// x^y for x in [0, 1] and y > 0; 0 if x^y is below 2^-1000. The relative error is as for
/// exponential(y log x).
[[nodiscard]] double power(double x, double y);

}  // namespace microtrace
