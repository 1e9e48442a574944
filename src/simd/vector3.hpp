#pragma once
/// Two- and three-component vectors of lanes. They perform the same operations as GLM in the same
/// order, so results have the same bits. For one lane, GLM's own types are used.

#include "simd/masks.hpp"

#include <microtrace/math.hpp>

#include <glm/geometric.hpp>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Return the results of std::max and std::min: the first argument if both are equal or one is NaN.
template <class V>
inline V larger_of(const V& a, const V& b) {
  return a < b ? b : a;
}
template <class V>
inline V smaller_of(const V& a, const V& b) {
  return b < a ? b : a;
}

/// Returns a clamped to [low, high].
template <class V>
inline V clamped(const V& a, const V& low, const V& high) {
  return a < low ? low : high < a ? high : a;
}

template <class F>
struct Vector3 {
  F x, y, z;
};
template <class F>
struct Vector2 {
  F x, y;
};

template <int N>
struct VectorTypes {
  using float2 = Vector2<Float<N>>;
  using float3 = Vector3<Float<N>>;
  using double3 = Vector3<Double<N>>;
};
template <>
struct VectorTypes<1> {
  using float2 = Vec2;
  using float3 = Vec3;
  using double3 = DVec3;
};
template <int N>
using Floats2 = typename VectorTypes<N>::float2;
template <int N>
using Floats3 = typename VectorTypes<N>::float3;
template <int N>
using Doubles3 = typename VectorTypes<N>::double3;

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
/// A vector of lanes or a number, as opposed to a Vector3.
template <class S>
concept Scalar = !requires(const S& s) {
  s.x;
};

template <class F, Scalar S>
inline Vector3<F> operator+(const Vector3<F>& a, const S& b) {
  return {a.x + b, a.y + b, a.z + b};
}
template <class F, Scalar S>
inline Vector3<F> operator-(const Vector3<F>& a, const S& b) {
  return {a.x - b, a.y - b, a.z - b};
}
template <class F, Scalar S>
inline Vector3<F> operator*(const Vector3<F>& a, const S& b) {
  return {a.x * b, a.y * b, a.z * b};
}
template <class F, Scalar S>
inline Vector3<F> operator/(const Vector3<F>& a, const S& b) {
  return {a.x / b, a.y / b, a.z / b};
}
template <class F, Scalar S>
inline Vector3<F> operator+(const S& a, const Vector3<F>& b) {
  return {a + b.x, a + b.y, a + b.z};
}
template <class F, Scalar S>
inline Vector3<F> operator-(const S& a, const Vector3<F>& b) {
  return {a - b.x, a - b.y, a - b.z};
}
template <class F, Scalar S>
inline Vector3<F> operator*(const S& a, const Vector3<F>& b) {
  return {a * b.x, a * b.y, a * b.z};
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
template <class F, class Operand>
inline void operator+=(Vector3<F>& a, const Operand& b) {
  a = a + b;
}
template <class F, class Operand>
inline void operator*=(Vector3<F>& a, const Operand& b) {
  a = a * b;
}

/// Returns the magnitudes of the components.
template <class V>
inline V magnitudes(const V& v) {
  return {magnitude(v.x), magnitude(v.y), magnitude(v.z)};
}

/// Returns the sum of the magnitudes of the components.
template <class V>
inline auto magnitudes_sum(const V& v) {
  return magnitude(v.x) + magnitude(v.y) + magnitude(v.z);
}

/// Returns the same vector in all lanes.
template <int N>
inline Doubles3<N> all_lanes(const DVec3& v) {
  const Double<N> zero{};
  return {v.x - zero, v.y - zero, v.z - zero};  // v + 0 would change -0
}

template <class Mask, class F>
inline Vector3<F> select3(const Mask& mask, const Vector3<F>& a, const Vector3<F>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
template <class Mask, int n, class T, glm::qualifier Q>
inline glm::vec<n, T, Q> select3(const Mask& mask, const glm::vec<n, T, Q>& a,
                                 const glm::vec<n, T, Q>& b) {
  return mask ? a : b;
}

template <class V>
inline auto greatest_component(const V& v) {
  return larger_of(larger_of(v.x, v.y), v.z);
}
template <class V>
inline auto least_component(const V& v) {
  return smaller_of(smaller_of(v.x, v.y), v.z);
}
template <class V>
inline V least_components(const V& a, const V& b) {
  return {smaller_of(a.x, b.x), smaller_of(a.y, b.y), smaller_of(a.z, b.z)};
}
template <class V>
inline V greatest_components(const V& a, const V& b) {
  return {larger_of(a.x, b.x), larger_of(a.y, b.y), larger_of(a.z, b.z)};
}
/// Returns a mask of the lanes in which all components are zero.
template <class V>
inline auto is_zero(const V& v) {
  return (v.x == 0) & (v.y == 0) & (v.z == 0);
}
/// Returns 1 - v, for each component if v is a Vector3.
template <class V>
inline V complement(const V& v) {
  if constexpr (requires { v.x; })
    return {1 - v.x, 1 - v.y, 1 - v.z};
  else
    return 1 - v;
}
template <class V, class F>
inline V mixed(const V& a, const V& b, const F& share) {
  return a * (1 - share) + b * share;
}

/// Returns a vector whose three components are x.
template <int N>
inline Floats3<N> all3(const Float<N>& x) {
  return {x, x, x};
}
template <int N>
inline Floats3<N> all3(float x) requires(N > 1) {
  return all3<N>(all<N>(x));
}

template <int N>
inline Floats3<N> unit(const Floats3<N>& v) {
  return v * (1 / square_root<N>(dot(v, v)));
}

/// Convert between float32 and float64; the conversion to float32 rounds.
template <int N>
inline Doubles3<N> to_double3(const Floats3<N>& v) {
  return {to_double<N>(v.x), to_double<N>(v.y), to_double<N>(v.z)};
}
template <int N>
inline Floats3<N> to_single3(const Doubles3<N>& v) {
  return {to_single<N>(v.x), to_single<N>(v.y), to_single<N>(v.z)};
}

/// Loads float32 components as float64; narrowed3 rounds and stores them.
template <int N, int width>
inline Doubles3<N> widened3(const float (&v)[3][width], int i) {
  return {widened<N>(v[0] + i), widened<N>(v[1] + i), widened<N>(v[2] + i)};
}
template <int N, int width>
inline void narrowed3(const Doubles3<N>& v, float (&to)[3][width], int i) {
  narrowed<N>(v.x, to[0] + i);
  narrowed<N>(v.y, to[1] + i);
  narrowed<N>(v.z, to[2] + i);
}

template <int N, int width>
inline Floats3<N> load3(const float (&v)[3][width], int i) {
  return {load<N>(v[0] + i), load<N>(v[1] + i), load<N>(v[2] + i)};
}
template <int N, int width>
inline void store3(float (&to)[3][width], int i, const Floats3<N>& v) {
  store<N>(to[0] + i, v.x);
  store<N>(to[1] + i, v.y);
  store<N>(to[2] + i, v.z);
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
