#pragma once
/// SIMD vectors of float32 and float64. `Float<N>` uses the vector extension of GCC and Clang: it
/// has N lanes, with + - * / and ?: per lane. N is 4, 8 or 16, at most the register width of the
/// instruction set for which the including file is compiled. `Float<1>` is float, so scalar code is
/// an instance of the same templates. The bits of results do not depend on N, because IEEE 754
/// defines every operation. Type Lanes is a set of lanes: an integer with one bit per lane.
///
/// Each set of kernels has its own namespace (see kernel_sources in src/simd/CMakeLists.txt), so
/// that the linker can't merge code for different instruction sets.

#include <cstdint>

#ifndef MICROTRACE_KERNELS
#define MICROTRACE_KERNELS scalar
#endif

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

template <int N>
struct FloatVector {
  typedef float type __attribute__((vector_size(4 * N)));
  typedef std::int32_t bits_type __attribute__((vector_size(4 * N)));
};
template <>
struct FloatVector<1> {
  using type = float;
  using bits_type = std::int32_t;
};
template <int N>
using Float = typename FloatVector<N>::type;
template <int N>
using Int = typename FloatVector<N>::bits_type;

template <int N>
struct UnsignedVector {
  typedef std::uint32_t type __attribute__((vector_size(4 * N)));
};
template <>
struct UnsignedVector<1> {
  using type = std::uint32_t;
};
template <int N>
using Unsigned = typename UnsignedVector<N>::type;

template <int N>
struct DoubleVector {
  typedef double type __attribute__((vector_size(8 * N)));
  typedef std::int64_t bits_type __attribute__((vector_size(8 * N)));
};
template <>
struct DoubleVector<1> {
  using type = double;
  using bits_type = std::int64_t;
};
template <int N>
using Double = typename DoubleVector<N>::type;
template <int N>
using Long = typename DoubleVector<N>::bits_type;

/// The number of float64 lanes in a register with N lanes of float32.
template <int N>
constexpr int kDoubleLanes = N == 1 ? 1 : N / 2;

using Lanes = std::uint32_t;

template <int N>
constexpr Lanes kAllLanes = (Lanes{1} << N) - 1;

/// Returns the same bits as a different type of the same size.
template <class To, class From>
inline To reinterpreted(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  __builtin_memcpy(&to, &from, sizeof to);
  return to;
}

template <class V>
constexpr bool kIsScalar = __is_same(V, float) || __is_same(V, double) ||
                           __is_same(V, std::int32_t) || __is_same(V, std::uint32_t) ||
                           __is_same(V, bool);

/// Returns lane i of a vector, or the scalar itself.
template <class V>
inline auto lane(const V& v, int i) {
  if constexpr (kIsScalar<V>)
    return v;
  else
    return v[i];
}
template <class V, class Value>
inline void set_lane(V& v, int i, const Value& value) {
  if constexpr (kIsScalar<V>)
    v = value;
  else
    v[i] = value;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
