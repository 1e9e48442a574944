#pragma once
/// The exact parameter of a hit: a root of a polynomial of degree at most two with dyadic
/// coefficients.

#include "exact/numbers/dyadic.hpp"
#include "exact/numbers/ratio.hpp"

#include <compare>

namespace microtrace::exact {

/// t = (p + sign sqrt(q)) / r with r > 0 and q >= 0; rational if sign is 0.
struct Root {
  Dyadic p, q, r;
  int sign = 0;
};

/// The rational t as a root.
[[nodiscard]] inline Root rational(const Ratio<Dyadic>& t) {
  return {t.p, {}, t.r, 0};
}

/// The rational p / r, r not zero.
[[nodiscard]] Root rational(const Dyadic& p, const Dyadic& r);

/// The number t itself.
[[nodiscard]] Root rational(float t);

/// The exact order of the two real numbers.
[[nodiscard]] std::strong_ordering operator<=>(const Root& x, const Root& y);
[[nodiscard]] bool operator==(const Root& x, const Root& y);

/// A double close to x: see middle().
[[nodiscard]] double to_double(const Dyadic& x);

/// Doubles below and above t, a few units in the last place apart. If |t| is about 2^1000 or more,
/// or 2^-1000 or less, the upper bound may be infinity or the lower bound 0.
[[nodiscard]] Enclosure enclose(const Root& t);

/// The float32 nearest to t.
[[nodiscard]] float round_to_float(const Root& t);

}  // namespace microtrace::exact
