#include "exact/numbers/ratio.hpp"

#include <limits>

namespace microtrace::exact {

Enclosure bounds(int sign, const Scaled& size) {
  constexpr double margin = 0x1p-49;
  constexpr int limit = 1000;
  Enclosure e{};
  if (size.exponent > limit) {
    e = {std::ldexp(0.125, limit), std::numeric_limits<double>::infinity()};
  } else if (size.exponent < -limit) {
    e = {0.0, std::ldexp(8.0, -limit)};
  } else {
    e = {std::ldexp(size.mantissa * (1 - margin), size.exponent),
         std::ldexp(size.mantissa * (1 + margin), size.exponent)};
  }
  return sign < 0 ? Enclosure{-e.hi, -e.lo} : e;
}

double middle(int sign, const Leading& size) {
  const Enclosure e = bounds(sign, {2 * size.mantissa, size.exponent - 1});
  return (e.lo + e.hi) / 2;
}

}  // namespace microtrace::exact
