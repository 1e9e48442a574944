#pragma once
/// CrossProduct, Approximate and related types for N lanes. They perform the same operations in the
/// same order as the types in src/accel/filters, because the axis along which an origin is moved
/// depends on every bit.

#include "accel/filters/roundings.hpp"
#include "accel/spawn/kernels/kernel.hpp"
#include "simd/masks.hpp"

namespace microtrace {
namespace {

constexpr float kGreatestCoordinate = 0x1p64F;  // equals kLargestCoordinate of filter.hpp

/// A lane mask: all bits of a lane are set if a condition holds.
template <int N>
using DoubleMask = typename DoubleVector<N>::bits_type;

template <int N>
struct Doubles3 {
  Double<N> v[3];
};

template <int N>
inline Doubles3<N> widened3(const float (*p)[kSpawnLanes], int i) {
  return {{widened<N>(p[0] + i), widened<N>(p[1] + i), widened<N>(p[2] + i)}};
}
template <int N>
inline Doubles3<N> load3(const double (*p)[kSpawnLanes], int i) {
  Doubles3<N> result;
  for (int k = 0; k < 3; ++k) __builtin_memcpy(&result.v[k], p[k] + i, sizeof result.v[k]);
  return result;
}
template <int N>
inline void store3(const Doubles3<N>& a, double (*p)[kSpawnLanes], int i) {
  for (int k = 0; k < 3; ++k) __builtin_memcpy(p[k] + i, &a.v[k], sizeof a.v[k]);
}
template <int N>
inline Doubles3<N> operator-(const Doubles3<N>& a, const Doubles3<N>& b) {
  return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2]}};
}
template <int N>
inline Double<N> dot(const Doubles3<N>& a, const Doubles3<N>& b) {
  return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}
template <int N>
inline Doubles3<N> magnitudes(const Doubles3<N>& a) {
  return {{magnitude(a.v[0]), magnitude(a.v[1]), magnitude(a.v[2])}};
}

template <int N>
struct CrossProducts {
  Doubles3<N> value, permanent;

  CrossProducts(const Doubles3<N>& value_, const Doubles3<N>& permanent_)
      : value(value_), permanent(permanent_) {}
  static CrossProducts of(const Doubles3<N>& x, const Doubles3<N>& y) {
    const Doubles3<N> left{{x.v[1] * y.v[2], x.v[2] * y.v[0], x.v[0] * y.v[1]}};
    const Doubles3<N> right{{x.v[2] * y.v[1], x.v[0] * y.v[2], x.v[1] * y.v[0]}};
    const Doubles3<N> a = magnitudes<N>(left), b = magnitudes<N>(right);
    return {left - right, {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2]}}};
  }

  /// A dot product with a vector, and its error bound.
  struct Form {
    Double<N> value, error;
  };
  [[nodiscard]] Form along(const Doubles3<N>& x, int roundings) const {
    return {dot<N>(x, value),
            roundings * kRounding * dot<N>(magnitudes<N>(x), permanent) + kUnderflow};
  }
};

/// Returns the lanes whose components are within the filters' limit.
template <int N>
inline DoubleMask<N> filterable(const Doubles3<N>& x) {
  const double most = kGreatestCoordinate;
  return (magnitude(x.v[0]) <= most) & (magnitude(x.v[1]) <= most) & (magnitude(x.v[2]) <= most);
}

/// Returns x[axis] for each lane.
template <int N>
inline Double<N> component(const Doubles3<N>& x, const Double<N>& axis) {
  return axis == 0 ? x.v[0] : axis == 1 ? x.v[1] : x.v[2];
}

}  // namespace
}  // namespace microtrace
