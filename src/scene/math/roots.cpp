#include "scene/math/roots.hpp"

#include <cstddef>
#include <optional>
#include <utility>

namespace microtrace {
namespace {

/// A polynomial on an interval in the Bernstein basis. The number of sign changes among its
/// coefficients equals the number of roots in the interval, or exceeds it by an even number
/// (Descartes' rule of signs).
struct Bernstein {
  std::vector<double> b;
  double lo, hi;

  [[nodiscard]] bool may_have_root() const {
    return std::ranges::any_of(b, [](double x) { return x < 0; });
  }

  /// Splits the polynomial at the middle of the interval by De Casteljau's subdivision.
  [[nodiscard]] std::pair<Bernstein, Bernstein> halves() const {
    const double middle = (lo + hi) / 2;
    Bernstein left{.b = {}, .lo = lo, .hi = middle}, right{.b = b, .lo = middle, .hi = hi};
    for (std::size_t n = b.size(); n > 0; --n) {
      left.b.push_back(right.b[0]);
      for (std::size_t i = 0; i + 1 < n; ++i) right.b[i] = (right.b[i] + right.b[i + 1]) / 2;
    }
    return {std::move(left), std::move(right)};
  }
};

// Subdivides down to intervals of width 2^-50 and returns the start of the first one that may have
// a root. The polynomial is positive before it.
std::optional<double> first_root(const Bernstein& p) {
  if (!p.may_have_root()) return std::nullopt;
  if (p.hi - p.lo <= 0x1p-50) return p.lo;
  const auto [left, right] = p.halves();
  if (const auto root = first_root(left)) return root;
  return first_root(right);
}

}  // namespace

double least_positive_root(const std::vector<double>& c) {
  // Substitutes x = v / (1 - v) and multiplies by (1 - v)^n. Term i becomes c[i] / binomial(n, i)
  // times the Bernstein polynomial i of degree n.
  Bernstein p{.b = c, .lo = 0, .hi = 1};
  const std::size_t n = c.size() - 1;
  double binomial = 1;
  for (std::size_t i = 0; i <= n; ++i) {
    p.b[i] /= binomial;
    binomial = binomial * static_cast<double>(n - i) / static_cast<double>(i + 1);
  }
  const auto v = first_root(p);
  return v ? *v / (1 - *v) : std::numeric_limits<double>::infinity();
}

}  // namespace microtrace
