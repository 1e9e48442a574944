#pragma once
/// Vectors of exact numbers, generic over the number type.

#include "exact/numbers/dyadic.hpp"

#include <microtrace/math.hpp>

namespace microtrace::exact {

template <class Number>
struct VectorOf {
  Number x, y, z;

  const Number& operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};

using Vector = VectorOf<Dyadic>;

[[nodiscard]] inline Vector vector(const Vec3& v) {
  return {v.x, v.y, v.z};
}

template <class Number>
VectorOf<Number> operator-(const VectorOf<Number>& a, const VectorOf<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Number>
VectorOf<Number> operator+(const VectorOf<Number>& a, const VectorOf<Number>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class Number, class Other>
auto operator*(const Number& s, const VectorOf<Other>& a) -> VectorOf<decltype(s * a.x)> {
  return {s * a.x, s * a.y, s * a.z};
}

template <class Number, class Other>
[[nodiscard]] auto dot(const VectorOf<Number>& a, const VectorOf<Other>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Number>
[[nodiscard]] auto cross(const VectorOf<Number>& a, const VectorOf<Number>& b)
    -> VectorOf<decltype(a.x * b.x)> {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Returns the index of the first nonzero component, or -1 if all components are zero.
template <class Number>
[[nodiscard]] int nonzero_component(const VectorOf<Number>& a) {
  for (int k = 0; k < 3; ++k) {
    if (a[k].sign() != 0) return k;
  }
  return -1;
}

}  // namespace microtrace::exact
