#include <microtrace/shape.hpp>
#include <microtrace/short_vector.hpp>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Number = std::shared_ptr<int>;

Number number(int value) {
  return std::make_shared<int>(value);
}

TEST(ShortVector, TakesTheSizeOfAPointer) {
  EXPECT_EQ(sizeof(ShortVector<Array<Vec2>>), sizeof(void*));
}

TEST(ShortVector, IsEmptyAtFirst) {
  ShortVector<Number> list;
  EXPECT_THAT(list, IsEmpty());
  EXPECT_THROW((void)list.at(0), std::out_of_range);
  EXPECT_EQ(list, ShortVector<Number>(list));
}

TEST(ShortVector, GrowsAndShrinks) {
  const Number a = number(1), b = number(2);
  ShortVector<Number> list{a};
  list.push_back(b);
  list.resize(3);
  EXPECT_THAT(list, ElementsAre(a, b, nullptr));
  EXPECT_EQ(list.emplace_back(a), a);
  list.push_back(list.front());
  EXPECT_THAT(list, ElementsAre(a, b, nullptr, a, a));
  list.resize(2);
  EXPECT_THAT(list, ElementsAre(a, b));
  EXPECT_EQ(list.at(1), b);
  EXPECT_EQ(list.back(), b);
  list = {b};
  EXPECT_THAT(list, ElementsAre(b));
  list.clear();
  EXPECT_THAT(list, IsEmpty());
  EXPECT_EQ(a.use_count(), 1);
  EXPECT_EQ(b.use_count(), 1);
}

TEST(ShortVector, CopiesItsElements) {
  const Number a = number(1), b = number(2);
  const ShortVector<Number> list{a, b};
  ShortVector<Number> copy = list;
  EXPECT_EQ(copy, list);
  copy[0] = b;
  EXPECT_EQ(list[0], a);
  EXPECT_FALSE(copy == list);
  const ShortVector<Number> moved = std::move(copy);
  EXPECT_THAT(moved, ElementsAre(b, b));
  copy = list;
  EXPECT_THAT(copy, ElementsAre(a, b));
  EXPECT_EQ(a.use_count(), 3);
}

/// Throws when it is copied for the third time.
struct Fragile {
  Number owner;
  int* copies;

  Fragile(Number its_owner, int* its_copies) : owner(std::move(its_owner)), copies(its_copies) {}
  Fragile(Fragile&&) = default;
  Fragile(const Fragile& other) : owner(other.owner), copies(other.copies) {
    if (++*copies == 3) throw std::length_error("three copies");
  }
};

TEST(ShortVector, ReleasesElementsIfACopyFails) {
  const Number owner = number(1);
  int copies = -2;
  const ShortVector<Fragile> list{{owner, &copies}, {owner, &copies}, {owner, &copies}};
  copies = 0;
  EXPECT_THROW(ShortVector<Fragile>{list}, std::length_error);
  EXPECT_EQ(owner.use_count(), 4);
}

}  // namespace
}  // namespace microtrace
