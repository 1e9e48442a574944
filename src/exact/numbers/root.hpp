#pragma once
/// The exact parameter of a hit, which is a root of a polynomial of degree at most two with dyadic
/// coefficients.

#include "exact/numbers/dyadic.hpp"
#include "exact/numbers/ratio.hpp"

#include <compare>

namespace microtrace::exact {

/// The number t = (p + sign sqrt(q)) / r, where r > 0, q >= 0, and sign is -1, 0 or 1. If sign is
/// 0, t is rational and q is ignored.
struct Root {
  Dyadic p, q, r;
  int sign = 0;
};

/// Returns a quotient as a root.
[[nodiscard]] inline Root rational(const Ratio<Dyadic>& t) {
  return {t.p, {}, t.r, 0};
}

/// Returns the quotient p / r as a root, where r must not be zero.
[[nodiscard]] Root rational(const Dyadic& p, const Dyadic& r);

/// Returns the number t as a root.
[[nodiscard]] Root rational(float t);

/// Compares the two real numbers exactly.
[[nodiscard]] std::strong_ordering operator<=>(const Root& x, const Root& y);
[[nodiscard]] bool operator==(const Root& x, const Root& y);

/// Returns a double close to x, see middle().
[[nodiscard]] double to_double(const Dyadic& x);

/// Returns bounds of t that are a few units in the last place apart. If |t| is about 2^1000 or
/// more, the bound of larger magnitude may be infinite. If |t| is about 2^-1000 or less, the bound
/// of smaller magnitude may be 0.
[[nodiscard]] Enclosure enclose(const Root& t);

/// Returns the float32 nearest to t, ties to even.
[[nodiscard]] float round_to_float(const Root& t);

}  // namespace microtrace::exact
