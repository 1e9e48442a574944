#include "render/shading/primitive_set.hpp"

#include "base/memory_account.hpp"
#include "support/cases/adversarial_rays.hpp"

#include <microtrace/memory.hpp>

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

TEST(PrimitiveSet, EmptySetTakesNoMemory) {
  PrimitiveSet set(100, "primitives");
  set.insert(7, 7);
  EXPECT_EQ(set.pages(), nullptr);
  EXPECT_FALSE(is_in(set.pages(), 7));
}

TEST(PrimitiveSet, ContainsWhatWasInserted) {
  adversarial::Random random(51);
  for (int round = 0; round < 200; ++round) {
    const PrimitiveId count = 1 + random.bits() % (5 * BitPage::kNumbers);
    PrimitiveSet set(count, "primitives");
    std::vector<bool> expected(count);
    for (PrimitiveId i = random.bits() % 12; i > 0; --i) {
      const PrimitiveId first = random.bits() % count;
      // Ranges of pages, of any length, and of one primitive.
      PrimitiveId length = random.bits() % (i % 3 == 0 ? count : 2);
      if (i % 3 == 1)
        length = (1 + random.bits() % 3) * BitPage::kNumbers - first % BitPage::kNumbers;
      const PrimitiveId end = first + std::min(length, count - first);
      set.insert(first, end);
      std::fill(expected.begin() + first, expected.begin() + end, true);
    }
    for (PrimitiveId id = 0; id < count; ++id)
      ASSERT_EQ(is_in(set.pages(), id), expected[id]) << "round " << round << ", primitive " << id;
  }
}

TEST(PrimitiveSet, SetsAreIndependent) {
  PrimitiveSet first(3 * BitPage::kNumbers, "primitives"),
      second(3 * BitPage::kNumbers, "primitives");
  first.insert(0, 2 * BitPage::kNumbers + 1);
  second.insert(1, 2);
  EXPECT_TRUE(is_in(first.pages(), 2 * BitPage::kNumbers));
  EXPECT_FALSE(is_in(second.pages(), 0));
  EXPECT_FALSE(is_in(second.pages(), 2 * BitPage::kNumbers));
  first.clear();
  EXPECT_FALSE(is_in(first.pages(), 0));
  EXPECT_TRUE(is_in(second.pages(), 1));
}

// The one-sided instances of a forest of four billion triangles.
TEST(PrimitiveSet, LongRunsTakeLittleMemory) {
  MemoryBudget budget(9U << 20U);
  MemoryAccount account(&budget);
  const MemoryScope scope(account);
  const PrimitiveId count = 4'290'000'000;
  PrimitiveSet set(count, "primitives");
  set.insert(1, count);
  EXPECT_FALSE(is_in(set.pages(), 0));
  EXPECT_TRUE(is_in(set.pages(), 1));
  EXPECT_TRUE(is_in(set.pages(), count / 2));
  EXPECT_TRUE(is_in(set.pages(), count - 1));
}

}  // namespace
}  // namespace microtrace
