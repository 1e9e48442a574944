#pragma once
/// Converts float32 and Dyadic to CGAL's number types. Only the oracle tests use it.

#include "exact/numbers/dyadic.hpp"

#include <microtrace/math.hpp>

#include <CGAL/Gmpq.h>

namespace microtrace::oracle {

using Rational = CGAL::Gmpq;

[[nodiscard]] inline Rational to_rational(const exact::Dyadic& x) {
  mpz_t magnitude;
  mpz_init(magnitude);
  const auto limbs = x.limbs();
  mpz_import(magnitude, limbs.size(), -1, sizeof(limbs[0]), 0, 0, limbs.data());
  Rational result{CGAL::Gmpz(magnitude)};
  mpz_clear(magnitude);
  const auto shift = static_cast<mp_bitcnt_t>(64 * std::abs(x.exponent()));
  if (x.exponent() < 0) {
    mpq_div_2exp(result.mpq(), result.mpq(), shift);
  } else {
    mpq_mul_2exp(result.mpq(), result.mpq(), shift);
  }
  return x.sign() < 0 ? -result : result;
}

template <class Kernel>
[[nodiscard]] typename Kernel::Point_3 point(const Vec3& v) {
  using Number = typename Kernel::FT;
  return {Number(double{v.x}), Number(double{v.y}), Number(double{v.z})};
}

template <class Kernel>
[[nodiscard]] typename Kernel::Vector_3 vector(const Vec3& v) {
  using Number = typename Kernel::FT;
  return {Number(double{v.x}), Number(double{v.y}), Number(double{v.z})};
}

}  // namespace microtrace::oracle
