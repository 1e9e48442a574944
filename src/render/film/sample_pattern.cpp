#include "render/film/sample_pattern.hpp"

#include "simd/bit_reversal.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>

namespace microtrace {
std::vector<PixelOffset> sample_pattern(std::uint32_t n) {
  std::vector<std::uint32_t> by_row(n);
  std::iota(by_row.begin(), by_row.end(), 0U);
  std::ranges::sort(by_row, {}, reversed_bits<std::uint32_t>);
  std::vector<PixelOffset> pattern(n);
  for (std::uint32_t row = 0; row < n; ++row) {
    const std::uint32_t column = by_row[row];
    pattern[column] = {.x = (column + 0.5) / n, .y = (row + 0.5) / n};
  }
  return pattern;
}

}  // namespace microtrace
