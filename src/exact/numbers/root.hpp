#pragma once
/// The exact parameter of a hit: a root of a polynomial of degree at most two with dyadic
/// coefficients.

#include "exact/numbers/dyadic.hpp"
#include "exact/numbers/ratio.hpp"

#include <compare>

namespace microtrace::exact {

/// t = (p + sign sqrt(q)) / r with r > 0 and q >= 0; rational where sign is 0.
struct Root {
  Dyadic p, q, r;
  int sign = 0;
};

/// As a root.
[[nodiscard]] inline Root rational(const Ratio<Dyadic>& t) {
  return {t.p, {}, t.r, 0};
}

/// The rational p / r, r not zero.
[[nodiscard]] Root rational(const Dyadic& p, const Dyadic& r);

/// The number t itself.
[[nodiscard]] Root rational(float t);

/// The order of the two real numbers, decided without rounding.
[[nodiscard]] std::strong_ordering operator<=>(const Root& x, const Root& y);
[[nodiscard]] bool operator==(const Root& x, const Root& y);

/// A double next to x: see middle().
[[nodiscard]] double to_double(const Dyadic& x);

/// Doubles around t, a few units in the last place apart; where |t| is about 2^1000 or more, or
/// 2^-1000 or less, the upper bound may be infinity or the lower one 0.
[[nodiscard]] Enclosure enclose(const Root& t);

/// The float32 nearest to t.
[[nodiscard]] float round_to_float(const Root& t);

}  // namespace microtrace::exact
