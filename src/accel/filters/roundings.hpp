#pragma once
/// The number of roundings of terms that float64 computes about triangles: for filters, and for
/// kernels that evaluate the same formulas for several triangles at once. Plain constants; see
/// simd/vectors.hpp for the reason.

namespace microtrace {

/// Unit roundoff of float64.
inline constexpr double kRoundoff = 0x1p-53;

/// The relative error of one rounding, including second-order terms. For k roundings, up to 8, half
/// of the second-order part would suffice: 3 for 1 - k U, because the error of a rounding is at
/// most U / (1 + U) of its argument, k for the roundings of the permanent and 5 for those of the
/// bound.
inline constexpr double kRounding = kRoundoff * (1 + 32 * kRoundoff);

/// Above the total effect of underflow, some 2^-680; see filter.hpp.
inline constexpr double kUnderflow = 0x1p-600;

/// A product of the normal n = e1 x e2 with an exact vector: e1 and e2 have one rounding each,
/// their products one, the difference one; the product one, the sum two.
inline constexpr int kSlopeRoundings = 7;
/// With a difference of two exact vectors, which has one more.
inline constexpr int kHeightRoundings = 8;
/// A component of n times a difference of rounded numbers, in a sum of two that is divided: 4 for
/// n, then the difference, the product, the sum, the quotient.
inline constexpr int kTermRoundings = 8;
/// The roundings of a quotient itself: that of t and that of lo or hi.
inline constexpr int kQuotientRoundings = 2;

}  // namespace microtrace
