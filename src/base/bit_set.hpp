#pragma once
/// Sets of numbers, such as PrimitiveIds, as bits in pages. Runs of numbers that are all or none in
/// a set share two pages, so such a set of 2^32 numbers takes 8 MiB. Kernels for several
/// instruction sets include this header, so its functions have no external linkage.

#include <cstdint>

namespace microtrace {

/// The bits of kNumbers successive numbers.
struct BitPage {
  static constexpr std::uint32_t kNumbers = 4096;
  std::uint32_t bits[kNumbers / 32];
};
/// The pages of a set, or null for the empty set.
using BitPages = const BitPage* const*;

namespace {

/// True if a number is in the set.
inline bool is_in(BitPages pages, std::uint32_t number) {
  if (pages == nullptr) return false;
  const std::uint32_t i = number % BitPage::kNumbers;
  return (pages[number / BitPage::kNumbers]->bits[i / 32] >> i % 32 & 1U) != 0;
}

}  // namespace
}  // namespace microtrace
