#include "support/ellipsoid_box.hpp"

#include "exact/numbers/vector.hpp"

#include <array>

namespace microtrace {
namespace {

using exact::Dyadic;
using Matrix = std::array<std::array<Dyadic, 4>, 4>;

/// Returns the determinant of the matrix without a row and a column.
Dyadic minor(const Matrix& m, std::size_t row, std::size_t column) {
  std::array<exact::Vector, 3> rows;
  for (std::size_t i = 0, r = 0; i < 4; ++i) {
    if (i == row) continue;
    std::array<Dyadic, 3> v;
    for (std::size_t j = 0, c = 0; j < 4; ++j)
      if (j != column) v[c++] = m[i][j];
    rows[r++] = {v[0], v[1], v[2]};
  }
  return dot(rows[0], cross(rows[1], rows[2]));
}

}  // namespace

// With the symmetric matrix Q of the quadric, the planes u are tangent for which u^T adj(Q) u = 0.
// For the plane on which coordinate k is w, this is a quadratic polynomial in w. Its roots are the
// ends of the ellipsoid.
bool holds_ellipsoid(const Bounds& box, const Quadric& q) {
  const Dyadic sign(q.a < 0 ? -1.0F : 1.0F), two(2.0F);
  const Dyadic a = sign * q.a, b = sign * q.b, c = sign * q.c, d = sign * q.d, e = sign * q.e,
               f = sign * q.f, g = sign * q.g, h = sign * q.h, i = sign * q.i, j = sign * q.j;
  const Matrix m{{{two * a, d, e, g}, {d, two * b, f, h}, {e, f, two * c, i}, {g, h, i, two * j}}};
  const Dyadic square = minor(m, 3, 3);
  if (!(a.sign() > 0 && (two * a * two * b - d * d).sign() > 0 && square.sign() > 0)) return false;
  for (int k = 0; k < 3; ++k) {
    const auto row = static_cast<std::size_t>(k);
    const Dyadic constant = minor(m, row, row), unsigned_half = minor(m, 3, row);
    const Dyadic half = k == 1 ? -unsigned_half : unsigned_half;
    for (const float side : {-1.0F, 1.0F}) {
      const Dyadic w = side < 0 ? box.lo[k] : box.hi[k];
      const Dyadic slope = square * w + half;
      if ((slope * side).sign() < 0 || (slope * w + half * w + constant).sign() < 0) return false;
    }
  }
  return true;
}

}  // namespace microtrace
