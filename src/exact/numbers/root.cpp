#include "exact/numbers/root.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace microtrace::exact {
namespace {

/// Returns the sign of x + s sqrt(a), where s is -1, 0 or 1 and a >= 0.
int sign_of_sum(const Dyadic& x, int s, const Dyadic& a) {
  if (s == 0 || a.sign() == 0) return x.sign();
  if (x.sign() == 0 || x.sign() == s) return s;
  // The terms have opposite signs, so the one with the larger square decides.
  return x.sign() * compare(square(x), a);
}

/// Returns the sign of x + s sqrt(a) + t sqrt(b), where s and t are -1, 0 or 1, a >= 0 and b >= 0.
int sign_of_sum(const Dyadic& x, int s, const Dyadic& a, int t, const Dyadic& b) {
  if (s == 0 || a.sign() == 0) return sign_of_sum(x, t, b);
  if (t == 0 || b.sign() == 0) return sign_of_sum(x, s, a);
  const int roots = s == t ? s : s * compare(a, b);
  if (roots == 0) return x.sign();
  if (x.sign() == 0 || x.sign() == roots) return roots;
  // x and the sum of the roots have opposite signs, so the larger square decides: x^2 - (s sqrt(a)
  // + t sqrt(b))^2 = x^2 - a - b - 2 s t sqrt(a b).
  return x.sign() * sign_of_sum(square(x) - a - b, -s * t, twice(twice(a * b)));
}

/// Returns |x| for x != 0, truncated to 53 bits. The relative error is at most 2 u with u = 2^-53.
Scaled magnitude(const Dyadic& x) {
  const Leading leading = x.leading();
  return {leading.mantissa, leading.exponent};
}

/// Returns |p| + sqrt(q), which must not be zero. The relative error is at most 3 u: the square
/// root has (2 u) / 2 + u, and the sum adds u.
Scaled magnitude_plus_sqrt(const Dyadic& p, const Dyadic& q) {
  if (q.sign() == 0) return magnitude(p);
  Scaled root = magnitude(q);
  if (root.exponent % 2 != 0) {
    root.mantissa *= 2;
    --root.exponent;
  }
  root = {std::sqrt(root.mantissa), root.exponent / 2};
  if (p.sign() == 0) return root;
  Scaled large = magnitude(p);
  if (large.exponent < root.exponent) std::swap(large, root);
  const int shift = std::max(root.exponent - large.exponent, -200);
  return {large.mantissa + std::ldexp(root.mantissa, shift), large.exponent};
}

}  // namespace

Root rational(const Dyadic& p, const Dyadic& r) {
  return rational(ratio(p, r));
}

Root rational(float t) {
  return {Dyadic(t), {}, Dyadic(1.0f), 0};
}

std::strong_ordering operator<=>(const Root& x, const Root& y) {
  // Computes the sign of (x - y) x.r y.r, where x.r y.r is positive.
  const Dyadic difference = x.p * y.r - y.p * x.r;
  int sign = difference.sign();
  if (x.sign != 0 || y.sign != 0) {
    sign = sign_of_sum(difference, x.sign, square(y.r) * x.q, -y.sign, square(x.r) * y.q);
  }
  return sign <=> 0;
}

bool operator==(const Root& x, const Root& y) {
  return (x <=> y) == 0;
}

double to_double(const Dyadic& x) {
  return x.sign() == 0 ? 0 : middle(x.sign(), x.leading());
}

Enclosure enclose(const Root& t) {
  const Dyadic q = t.sign == 0 ? Dyadic() : t.q;
  const bool cancels = q.sign() != 0 && t.p.sign() == -t.sign;
  int sign = t.p.sign() != 0 ? t.p.sign() : t.sign;
  Scaled numerator, denominator;
  if (cancels) {
    // Uses p + s sqrt(q) = (p^2 - q) / (p - s sqrt(q)), where the numerator is exact and the terms
    // of the denominator have equal signs.
    const Dyadic product = square(t.p) - q;
    if (product.sign() == 0) return {0, 0};
    sign *= product.sign();
    numerator = magnitude(product);
    denominator = magnitude_plus_sqrt(t.p, q);
    const Scaled r = magnitude(t.r);
    denominator = {denominator.mantissa * r.mantissa, denominator.exponent + r.exponent};
  } else {
    if (t.p.sign() == 0 && q.sign() == 0) return {0, 0};
    numerator = magnitude_plus_sqrt(t.p, q);
    denominator = magnitude(t.r);
  }
  return bounds(
      sign, {numerator.mantissa / denominator.mantissa, numerator.exponent - denominator.exponent});
}

float round_to_float(const Root& t) {
  return round_to_float(enclose(t),
                        [&](double x) { return t <=> rational(Dyadic(x), Dyadic(1.0F)); });
}

}  // namespace microtrace::exact
