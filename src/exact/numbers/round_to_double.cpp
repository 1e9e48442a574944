#include "exact/numbers/round_to_double.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace microtrace::exact {
namespace {

/// Rounds a positive number. The bits of positive doubles are ordered like the numbers, so the two
/// neighbors of t are found by bisection of the bits between the bounds of t.
double round_positive(const Root& t) {
  const Enclosure bounds = enclose(t);
  auto below = std::bit_cast<std::uint64_t>(bounds.lo);
  auto above = std::bit_cast<std::uint64_t>(bounds.hi);
  while (above - below > 1) {
    const std::uint64_t middle = below + (above - below) / 2;
    const auto order = t <=> rational(Dyadic(std::bit_cast<double>(middle)), 1.0F);
    if (order == 0) return std::bit_cast<double>(middle);
    (order < 0 ? above : below) = middle;
  }
  if (above == below) return bounds.lo;
  // The step to the next number is exact. IEEE 754 rounds as if 2^1024 were the number after the
  // largest one.
  const auto lower = std::bit_cast<double>(below), upper = std::bit_cast<double>(above);
  const double step = std::isinf(upper) ? 0x1p971 : upper - lower;
  const Dyadic midpoint = Dyadic(lower) + Dyadic(step) * Dyadic(0.5F);
  const auto order = t <=> rational(midpoint, 1.0F);
  if (order != 0) return order < 0 ? lower : upper;
  return below % 2 == 0 ? lower : upper;
}

}  // namespace

double round_to_double(const Root& t) {
  const auto side = t <=> rational(0.0F);
  if (side == 0) return 0;
  if (side > 0) return round_positive(t);
  return -round_positive({-t.p, t.q, t.r, -t.sign});
}

}  // namespace microtrace::exact
