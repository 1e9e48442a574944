#include "scene/math/trigonometry.hpp"

#include "simd/trigonometry.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace microtrace {
namespace {

// Taylor polynomial on [0, tan(pi/16)]. The first omitted term is less than 2^-55 times the sum.
double atan_kernel(double x) {
  const double z = x * x;
  double s = 0;
  for (int k = 23; k >= 3; k -= 2) s = z * (1.0 / k - s);
  return x - x * s;
}

using Angle = ReducedAngle<1>;

// Reduces an angle to [-45, 45] degrees and a multiple of 90 degrees. std::fmod is exact.
Angle reduced_degrees(double x) {
  const double turn = std::fmod(x, 360.0);
  const double n = std::floor(turn / 90 + 0.5);
  return {radians_from_degrees(turn - 90 * n), static_cast<std::int64_t>(n)};
}

}  // namespace

double sin_radians(double x) {
  return reduced_radians<1>(x).sine();
}
double cos_radians(double x) {
  return cos_radians<1>(x);
}
double tan_radians(double x) {
  const Angle angle = reduced_radians<1>(x);
  return angle.sine() / angle.cosine();
}
double atan_radians(double x) {
  const double magnitude = std::abs(x);
  if (magnitude > 1) return std::copysign(std::numbers::pi / 2 - atan_radians(1 / magnitude), x);
  const bool near_one = magnitude > std::numbers::sqrt2 - 1;  // the tangent of pi/8
  const double tangent = near_one ? (magnitude - 1) / (magnitude + 1) : magnitude;
  const double half = 2 * atan_kernel(tangent / (1 + std::sqrt(1 + tangent * tangent)));
  return std::copysign(near_one ? std::numbers::pi / 4 + half : half, x);
}
double atan2_radians(double y, double x) {
  if (x == 0 && y == 0) return 0;
  const double angle = atan_radians(std::abs(y) / std::abs(x));
  return std::copysign(x < 0 ? std::numbers::pi - angle : angle, y);
}
double sin_degrees(double x) {
  return reduced_degrees(x).sine();
}
double cos_degrees(double x) {
  return reduced_degrees(x).cosine();
}
double radians_from_degrees(double x) {
  return x * (std::numbers::pi / 180);
}

}  // namespace microtrace
