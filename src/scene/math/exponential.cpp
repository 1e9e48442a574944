#include "scene/math/exponential.hpp"

#include "simd/exponential.hpp"

namespace microtrace {

double power_of_two(double x) {
  return power_of_two<1>(x);
}

double binary_logarithm(double x) {
  return binary_logarithm<1>(x);
}

double exponential(double x) {
  return exponential<1>(x);
}

double power(double x, double y) {
  return power<1>(x, y);
}

}  // namespace microtrace
