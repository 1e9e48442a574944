#pragma once
/// Sets of numbers, such as PrimitiveIds, with one bit per number. Kernels for several instruction
/// sets include this header, so its functions have no external linkage.

#include <cstddef>
#include <cstdint>

namespace microtrace {
namespace {

/// Number of elements of an array that holds a set of numbers below `count`.
constexpr std::size_t bit_set_size(std::size_t count) {
  return count / 32 + 1;
}
/// True if a number is in the set. Null stands for the empty set.
inline bool is_in(const std::uint32_t* bits, std::uint32_t number) {
  return bits != nullptr && (bits[number / 32] >> number % 32 & 1U) != 0;
}
inline void insert(std::uint32_t* bits, std::uint32_t number) {
  bits[number / 32] |= 1U << number % 32;
}
/// Inserts all numbers from `first` to `last` - 1.
inline void insert(std::uint32_t* bits, std::uint32_t first, std::uint32_t last) {
  while (first < last) {
    if (first % 32 == 0 && last - first >= 32) {
      bits[first / 32] = ~0U;
      first += 32;
    } else {
      insert(bits, first++);
    }
  }
}

}  // namespace
}  // namespace microtrace
