#pragma once
/// The number of roundings of terms that are computed about triangles in float64: for filters, and
/// for kernels that evaluate the same formulas for several triangles at a time. Plain constants
/// only; see simd/vectors.hpp for the reason.

namespace microtrace {

/// Unit roundoff of float64.
inline constexpr double kRoundoff = 0x1p-53;

/// The relative error of one rounding, including second-order terms. For k roundings, up to 8, half
/// of the second-order part would suffice: 3 for 1 - k U, because the error of a rounding is at
/// most U / (1 + U) of its argument, k for the roundings of the permanent and 5 for those of the
/// bound.
inline constexpr double kRounding = kRoundoff * (1 + 32 * kRoundoff);

/// Above the total effect of underflow, which is about 2^-680; see filter.hpp.
inline constexpr double kUnderflow = 0x1p-600;

/// Roundings of the product of the normal n = e1 x e2 with an exact vector: one of e1 and e2, one
/// of their products, one of the difference; one of the product, two of the sum.
inline constexpr int kSlopeRoundings = 7;
/// The same for a difference of two exact vectors, which has one more rounding.
inline constexpr int kHeightRoundings = 8;
/// Roundings of a component of n times a difference of rounded numbers, in a sum of two that is
/// divided: four of n, one each of the difference, the product, the sum, the quotient.
inline constexpr int kTermRoundings = 8;
/// Roundings of a quotient itself: that of t and that of lo or hi.
inline constexpr int kQuotientRoundings = 2;

}  // namespace microtrace
