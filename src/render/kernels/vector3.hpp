#pragma once
/// Three-dimensional vectors of lanes. They perform the same operations as GLM in the same order,
/// so that bits are the same.

#include "simd/vectors.hpp"

namespace microtrace {
namespace {

/// The result of std::max and std::min: the first argument if they are equal or one is NaN.
template <class V>
inline V larger_of(const V& a, const V& b) {
  return a < b ? b : a;
}
template <class V>
inline V smaller_of(const V& a, const V& b) {
  return b < a ? b : a;
}

template <class F>
struct Vector3 {
  F x, y, z;
};

template <class F>
inline Vector3<F> operator+(const Vector3<F>& a, const Vector3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
inline Vector3<F> operator-(const Vector3<F>& a, const Vector3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
inline Vector3<F> operator*(const Vector3<F>& a, const Vector3<F>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class F>
inline Vector3<F> operator/(const Vector3<F>& a, const Vector3<F>& b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}
template <class F>
inline Vector3<F> operator+(const Vector3<F>& a, const F& b) {
  return {a.x + b, a.y + b, a.z + b};
}
template <class F>
inline Vector3<F> operator-(const F& a, const Vector3<F>& b) {
  return {a - b.x, a - b.y, a - b.z};
}
template <class F>
inline Vector3<F> operator*(const F& a, const Vector3<F>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <class F>
inline Vector3<F> operator/(const Vector3<F>& a, const F& b) {
  return {a.x / b, a.y / b, a.z / b};
}
template <class F>
inline Vector3<F> operator-(const Vector3<F>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class F>
inline F dot(const Vector3<F>& a, const Vector3<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
inline Vector3<F> cross(const Vector3<F>& a, const Vector3<F>& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
template <class M, class F>
inline Vector3<F> select3(const M& mask, const Vector3<F>& a, const Vector3<F>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

/// For floats.
template <int N>
inline Vector3<Float<N>> unit(const Vector3<Float<N>>& v) {
  return v / square_root<N>(dot(v, v));
}

template <int N>
inline Vector3<Float<N>> load3(const float (&v)[3][16], int i) {
  return {load<N>(v[0] + i), load<N>(v[1] + i), load<N>(v[2] + i)};
}
template <int N>
inline void store3(float (&to)[3][16], int i, const Vector3<Float<N>>& v) {
  store<N>(to[0] + i, v.x);
  store<N>(to[1] + i, v.y);
  store<N>(to[2] + i, v.z);
}

}  // namespace
}  // namespace microtrace
