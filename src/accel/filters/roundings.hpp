#pragma once
/// How often the terms of what float64 computes about triangles are rounded: for filters, and for
/// kernels that compute the same for several at once. Plain constants; see simd/vectors.hpp for
/// why.

namespace microtrace {

/// Unit roundoff of float64.
inline constexpr double kRoundoff = 0x1p-53;

/// One rounding, and a little more for what is of the second order. For k of them, up to 8, half of
/// that would do: 3 for 1 - k U, since a rounding is at most U / (1 + U) of what it rounds, k for
/// the roundings of the permanent and 5 for those of the bound.
inline constexpr double kRounding = kRoundoff * (1 + 32 * kRoundoff);

/// Above all that underflow can add, some 2^-680: filter.hpp counts it.
inline constexpr double kUnderflow = 0x1p-600;

/// A product of the normal n = e1 x e2 with an exact vector: e1 and e2 one each, their products
/// one, the difference one; the product one, the sum two.
inline constexpr int kSlopeRoundings = 7;
/// With a difference of two exact vectors, which has one more.
inline constexpr int kHeightRoundings = 8;
/// A component of n times a difference of rounded numbers, of which the sum of two is divided: 4
/// for n, the difference, the product, the sum, the quotient.
inline constexpr int kTermRoundings = 8;
/// A quotient's own: t's and that of lo or hi.
inline constexpr int kQuotientRoundings = 2;

}  // namespace microtrace
