#pragma once
/// SIMD vectors of float32 and float64. `Float<N>` is the vector extension of GCC and Clang: N
/// lanes, with + - * / and ?: per lane. N is at most the register width of the instruction set for
/// which the including file is compiled: 4, 8 or 16; `Float<1>` is float, so that scalar code is
/// an instance of the same templates. All widths give the same bits, because every operation is
/// defined by IEEE 754. A set of lanes is an integer with one bit per lane.
///
/// Each set of kernels has a namespace of its own (kernel_sources in src/simd/CMakeLists.txt), so
/// that the linker can't merge code of different instruction sets.

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

/// The lanes of float64 in a register that has N lanes of float32.
template <int N>
constexpr int kDoubleLanes = N == 1 ? 1 : N / 2;

using Lanes = std::uint32_t;

template <int N>
constexpr Lanes kAllLanes = (Lanes{1} << N) - 1;

/// The same bits as another type of the same size.
template <class To, class From>
inline To reinterpreted(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  __builtin_memcpy(&to, &from, sizeof to);
  return to;
}

template <class V>
constexpr bool kIsScalar = __is_same(V, float) || __is_same(V, double) ||
                           __is_same(V, std::int32_t) || __is_same(V, bool);

/// Lane i of a vector or scalar.
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
