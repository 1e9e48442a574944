#include "render/shading/primitive_set.hpp"

#include "base/memory_account.hpp"

#include <algorithm>

namespace microtrace {
namespace {

// Never written to.
constinit BitPage no_numbers{};
constinit BitPage all_numbers = [] {
  BitPage page{};
  std::ranges::fill(page.bits, ~std::uint32_t{0});
  return page;
}();

}  // namespace

void PrimitiveSet::insert(PrimitiveId first, PrimitiveId end) {
  if (first == end) return;
  if (pages_.empty()) {
    const std::size_t count = std::size_t{count_} / BitPage::kNumbers + 1;
    take_memory(count * sizeof(BitPage*), what_);
    pages_.assign(count, &no_numbers);
  }
  while (first < end) {
    const PrimitiveId begin = first % BitPage::kNumbers;
    const PrimitiveId part = std::min(end - first, BitPage::kNumbers - begin);
    insert_into(first / BitPage::kNumbers, begin, begin + part);
    first += part;
  }
}

void PrimitiveSet::insert_into(std::size_t page, std::uint32_t first, std::uint32_t end) {
  if (end - first == BitPage::kNumbers) pages_[page] = &all_numbers;
  if (pages_[page] == &all_numbers) return;
  if (pages_[page] == &no_numbers) {
    take_memory(sizeof(BitPage), what_);
    pages_[page] = mixed_.emplace_back(std::make_unique<BitPage>()).get();
  }
  for (std::uint32_t i = first; i < end; ++i) pages_[page]->bits[i / 32] |= 1U << i % 32;
}

void PrimitiveSet::clear() {
  pages_.clear();
  mixed_.clear();
}

}  // namespace microtrace
