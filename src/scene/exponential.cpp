#include "scene/exponential.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace microtrace {

double power_of_two(double x) {
  const double whole = std::floor(x + 0.5);
  const double y = (x - whole) * std::numbers::ln2;  // in [-0.347, 0.347]
  // Taylor polynomial of e^y: the first omitted term is below 2^-57.
  double sum = 1;
  for (int k = 13; k > 0; --k) sum = 1 + y * sum / k;
  const auto exponent = static_cast<std::int64_t>(whole) + 1023;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(exponent) << 52U);
}

double binary_logarithm(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>(bits >> 52U) - 1023;
  constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52U) - 1;
  double m = std::bit_cast<double>((bits & kFraction) | std::uint64_t{1023} << 52U);
  if (m > std::numbers::sqrt2) {
    m /= 2;
    ++exponent;
  }
  // ln m = 2 artanh s with |s| <= 0.1716; the first omitted term is below 2^-60.
  const double s = (m - 1) / (m + 1), z = s * s;
  double sum = 0;
  for (int k = 21; k > 0; k -= 2) sum = 1.0 / k + z * sum;
  return static_cast<double>(exponent) + 2 / std::numbers::ln2 * (s * sum);
}

double exponential(double x) {
  return x < -690 ? 0 : power_of_two(x * std::numbers::log2e);
}

double power(double x, double y) {
  if (!(x >= 0x1p-1000)) return 0;
  const double exponent = y * binary_logarithm(x);
  return exponent < -1000 ? 0 : power_of_two(exponent);
}

}  // namespace microtrace
