#pragma once
/// Runs of equal elements.

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace microtrace {

/// Calls f(value, count) for each run of elements with the same bits.
template <class T, class F>
void for_each_run(std::span<const T> values, F&& f) {
  static_assert(std::is_trivially_copyable_v<T>);
  constexpr std::size_t kStep = 8, kLongStep = 64;
  const auto continues = [&](std::size_t end, std::size_t count) {
    return end + count <= values.size() &&
           std::memcmp(&values[end - 1], &values[end], count * sizeof(T)) == 0;
  };
  for (std::size_t first = 0; first < values.size();) {
    std::size_t end = first + 1;
    while (continues(end, kLongStep)) end += kLongStep;
    while (continues(end, kStep)) end += kStep;
    while (continues(end, 1)) ++end;
    f(values[first], end - first);
    first = end;
  }
}

}  // namespace microtrace
