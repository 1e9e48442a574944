#pragma once
/// The numbers of roundings in float64 formulas for triangles. Filters use them, and so do kernels
/// that evaluate the same formulas for several triangles at a time. This header may contain only
/// plain constants, because kernels for several instruction sets include it.

namespace microtrace {

/// Unit roundoff of float64.
inline constexpr double kRoundoff = 0x1p-53;

/// A bound of the relative error per rounding, including second-order terms: k kRounding bounds the
/// error of up to k = 8 roundings. Half of the 32 would suffice: 3 for the divisor 1 - k U (because
/// the error of a rounding is at most U / (1 + U) times its argument), k for the roundings of the
/// permanent, and 5 for the roundings of the bound.
inline constexpr double kRounding = kRoundoff * (1 + 32 * kRoundoff);

/// Upper bound of the total effect of underflow, which is about 2^-680; see filter.hpp.
inline constexpr double kUnderflow = 0x1p-600;

/// Roundings of the dot product of the normal n = e1 x e2 with an exact vector: one each of e1 and
/// e2, one of their products and one of the difference; then one of the product with the vector and
/// two of the sum.
inline constexpr int kSlopeRoundings = 7;
/// Roundings of the dot product of n with a difference of two exact vectors, which adds one
/// rounding.
inline constexpr int kHeightRoundings = 8;
/// Roundings of a term in (n_i x + n_j y) / z, where x and y are rounded differences: four of n_i,
/// and one each of the difference, the product, the sum and the quotient.
inline constexpr int kTermRoundings = 8;
/// Roundings of the quotient itself: one of t, and one of lo or hi.
inline constexpr int kQuotientRoundings = 2;

}  // namespace microtrace
