#include "exact/numbers/ratio.hpp"

#include <limits>

namespace microtrace::exact {

Enclosure bounds(int sign, const Scaled& size) {
  constexpr double kMargin = 0x1p-49;
  constexpr int kLimit = 1000;
  Enclosure e{};
  if (size.exponent > kLimit) {
    e = {std::ldexp(0.125, kLimit), std::numeric_limits<double>::infinity()};
  } else if (size.exponent < -kLimit) {
    e = {0.0, std::ldexp(8.0, -kLimit)};
  } else {
    e = {std::ldexp(size.mantissa * (1 - kMargin), size.exponent),
         std::ldexp(size.mantissa * (1 + kMargin), size.exponent)};
  }
  return sign < 0 ? Enclosure{-e.hi, -e.lo} : e;
}

double middle(int sign, const Leading& size) {
  const Enclosure e = bounds(sign, {2 * size.mantissa, size.exponent - 1});
  return (e.lo + e.hi) / 2;
}

}  // namespace microtrace::exact
