#pragma once
/// Transposes matrices, and loads the rows of arrays as columns.

#include "simd/vectors.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Exchanges the upper right with the lower left blocks of size kStep in two rows, whose distance
/// is kStep. The rows consist of blocks of size 2 kStep.
template <int N, int kStep, std::size_t... kColumns>
inline void exchange_blocks(Float<N>& a, Float<N>& b,
                            std::index_sequence<kColumns...> /*columns*/) {
  constexpr int kSize = kStep;
  const Float<N> upper =
      __builtin_shufflevector(a, b,
                              ((kColumns & kSize) != 0 ? N + static_cast<int>(kColumns) - kSize
                                                       : static_cast<int>(kColumns))...);
  const Float<N> lower =
      __builtin_shufflevector(a, b,
                              ((kColumns & kSize) != 0 ? N + static_cast<int>(kColumns)
                                                       : static_cast<int>(kColumns) + kSize)...);
  a = upper;
  b = lower;
}

/// Transposes the kSize x kSize matrices that lie side by side in kSize rows of N lanes, first
/// their blocks of size kStep, then the contents of the blocks.
template <int N, int kSize, int kStep = kSize / 2>
inline void transpose(Float<N> (&m)[kSize]) {
  if constexpr (kStep > 0) {
    for (int i = 0; i < kSize; ++i) {
      if ((i & kStep) == 0)
        exchange_blocks<N, kStep>(m[i], m[i + kStep], std::make_index_sequence<N>{});
    }
    transpose<N, kSize, kStep / 2>(m);
  }
}

template <int N, std::size_t... kLanes>
inline Float<N> joined(const Float<N / 2>& low, const Float<N / 2>& high,
                       std::index_sequence<kLanes...> /*lanes*/) {
  return __builtin_shufflevector(low, high, static_cast<int>(kLanes)...);
}

/// Loads the rows indices[0], indices[kColumns], indices[2 kColumns] ... side by side.
template <int N, int kColumns>
inline Float<N> load_side_by_side(const float* array, const std::uint32_t* indices) {
  if constexpr (N == kColumns) {
    return load<N>(array + kColumns * std::size_t{*indices});
  } else {
    return joined<N>(load_side_by_side<N / 2, kColumns>(array, indices),
                     load_side_by_side<N / 2, kColumns>(array, indices + N / 2),
                     std::make_index_sequence<N>{});
  }
}

/// Loads row indices[i] of an array into lane i of the columns. Rows have kColumns floats, a
/// multiple or a divisor of N.
template <int N, int kColumns>
inline void load_rows(const float* array, const std::uint32_t (&indices)[N],
                      Float<N> (&columns)[kColumns]) {
  if constexpr (N == 1) {
    for (int k = 0; k < kColumns; ++k)
      columns[k] = array[kColumns * std::size_t{indices[0]} + static_cast<std::size_t>(k)];
  } else if constexpr (kColumns < N) {
    static_assert(N % kColumns == 0);
    for (int k = 0; k < kColumns; ++k)
      columns[k] = load_side_by_side<N, kColumns>(array, indices + k);
    transpose<N>(columns);
  } else {
    static_assert(kColumns % N == 0);
    for (int first = 0; first < kColumns; first += N) {
      Float<N> block[N];
      for (int i = 0; i < N; ++i)
        block[i] = load<N>(array + kColumns * std::size_t{indices[i]} + first);
      transpose<N>(block);
      for (int k = 0; k < N; ++k) columns[first + k] = block[k];
    }
  }
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
