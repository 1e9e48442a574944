#pragma once
/// Vectors of exact numbers, so that formulas read as they are written.

#include "exact/dyadic.hpp"

#include <microtrace/math.hpp>

#include <array>

namespace microtrace::exact {

struct Vector {
  Dyadic x, y, z;

  const Dyadic& operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};

[[nodiscard]] inline Vector vector(const Vec3& v) {
  return {v.x, v.y, v.z};
}

inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Vector operator*(const Dyadic& s, const Vector& a) {
  return {s * a.x, s * a.y, s * a.z};
}

[[nodiscard]] inline Dyadic dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[nodiscard]] inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The first component that is not zero, or -1.
[[nodiscard]] inline int nonzero_component(const Vector& a) {
  for (int k = 0; k < 3; ++k) {
    if (a[k].sign() != 0) return k;
  }
  return -1;
}

}  // namespace microtrace::exact
