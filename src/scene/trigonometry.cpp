#include "scene/trigonometry.hpp"

#include <cmath>
#include <numbers>

namespace microtrace {
namespace {

// Taylor polynomials on [-pi/4, pi/4]: the first omitted term is below 2^-63.
double sin_kernel(double x) {
  const double z = x * x;
  double s = 1.0 / 355687428096000.0;  // 17!
  s = s * z - 1.0 / 1307674368000.0;   // 15!
  s = s * z + 1.0 / 6227020800.0;      // 13!
  s = s * z - 1.0 / 39916800.0;        // 11!
  s = s * z + 1.0 / 362880.0;          // 9!
  s = s * z - 1.0 / 5040.0;            // 7!
  s = s * z + 1.0 / 120.0;             // 5!
  s = s * z - 1.0 / 6.0;               // 3!
  return x + x * (z * s);
}

double cos_kernel(double x) {
  const double z = x * x;
  double c = -1.0 / 6402373705728000.0;  // 18!
  c = c * z + 1.0 / 20922789888000.0;    // 16!
  c = c * z - 1.0 / 87178291200.0;       // 14!
  c = c * z + 1.0 / 479001600.0;         // 12!
  c = c * z - 1.0 / 3628800.0;           // 10!
  c = c * z + 1.0 / 40320.0;             // 8!
  c = c * z - 1.0 / 720.0;               // 6!
  c = c * z + 1.0 / 24.0;                // 4!
  return 1.0 - (0.5 * z - z * z * c);
}

// Taylor polynomial on [0, tan(pi/16)]: the first omitted term is below 2^-55 of the sum.
double atan_kernel(double x) {
  const double z = x * x;
  double s = 0;
  for (int k = 23; k >= 3; k -= 2) s = z * (1.0 / k - s);
  return x - x * s;
}

struct Reduced {
  double angle;  // radians, in [-pi/4, pi/4]
  int quadrant;  // 0 to 3
};

int quadrant_of(double quarter_turns) {
  return static_cast<int>(static_cast<long long>(quarter_turns) & 3);
}

// Cody and Waite's reduction: pi/2 in three parts of 33 bits, so that the first two products with n
// are exact.
Reduced reduce_radians(double x) {
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34,
                   kPart3 = 0x1.3198a2e037073p-69;
  const double n = std::floor(x * (2 / std::numbers::pi) + 0.5);
  return {.angle = ((x - n * kPart1) - n * kPart2) - n * kPart3, .quadrant = quadrant_of(n)};
}

// fmod is exact.
Reduced reduce_degrees(double x) {
  const double turn = std::fmod(x, 360.0);
  const double n = std::floor(turn / 90 + 0.5);
  return {.angle = radians_from_degrees(turn - 90 * n), .quadrant = quadrant_of(n)};
}

double sin_of(Reduced r) {
  const double value = (r.quadrant & 1) != 0 ? cos_kernel(r.angle) : sin_kernel(r.angle);
  return (r.quadrant & 2) != 0 ? -value : value;
}

double cos_of(Reduced r) {
  return sin_of({.angle = r.angle, .quadrant = (r.quadrant + 1) & 3});
}

}  // namespace

double sin_radians(double x) {
  return sin_of(reduce_radians(x));
}
double cos_radians(double x) {
  return cos_of(reduce_radians(x));
}
double tan_radians(double x) {
  const Reduced r = reduce_radians(x);
  return sin_of(r) / cos_of(r);
}
double atan_radians(double x) {
  const double magnitude = std::abs(x);
  if (magnitude > 1) return std::copysign(std::numbers::pi / 2 - atan_radians(1 / magnitude), x);
  const bool near_one = magnitude > std::numbers::sqrt2 - 1;  // the tangent of pi/8
  const double tangent = near_one ? (magnitude - 1) / (magnitude + 1) : magnitude;
  const double half = 2 * atan_kernel(tangent / (1 + std::sqrt(1 + tangent * tangent)));
  return std::copysign(near_one ? std::numbers::pi / 4 + half : half, x);
}
double sin_degrees(double x) {
  return sin_of(reduce_degrees(x));
}
double cos_degrees(double x) {
  return cos_of(reduce_degrees(x));
}
double radians_from_degrees(double x) {
  return x * (std::numbers::pi / 180);
}

}  // namespace microtrace
