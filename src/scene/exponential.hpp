#pragma once
/// Powers of two and their inverse, whose bits depend on IEEE 754 alone, as those of
/// trigonometry.hpp do. Errors stay below two units in the last place, those of the logarithm below
/// 2^-52 where it is less than 1.

namespace microtrace {

/// 2^x for x in [-1000, 1000].
[[nodiscard]] double power_of_two(double x);

/// x is a finite normal number above 0.
[[nodiscard]] double binary_logarithm(double x);

}  // namespace microtrace
