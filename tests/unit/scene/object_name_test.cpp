#include <microtrace/object_name.hpp>

#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

TEST(ObjectName, KeepsAText) {
  const std::string text = "a name of more than sixteen letters";
  EXPECT_EQ(ObjectName(text).str(), text);
  EXPECT_EQ(ObjectName("").str(), "");
  EXPECT_TRUE(ObjectName().empty() && ObjectName("").empty());
  EXPECT_FALSE(ObjectName(text).empty());
}

TEST(ObjectName, PutsTheNumberBetweenHeadAndTail) {
  const ObjectName name = ObjectName::numbered("field[", "]/cube");
  EXPECT_EQ(name.str(), "field[0]/cube");
  EXPECT_EQ(name.with_number(4294967295U).str(), "field[4294967295]/cube");
  EXPECT_EQ(name.with_number(17), ObjectName("field[17]/cube"));
  EXPECT_FALSE(name.with_number(17) == name);
  EXPECT_EQ(ObjectName("plain").with_number(3).str(), "plain");
  EXPECT_EQ(ObjectName().with_number(3).str(), "");
}

TEST(ObjectName, OutlivesTheNamesItSharesTextWith) {
  std::optional<ObjectName> first = ObjectName::numbered("n", "");
  ObjectName second = first->with_number(2);
  ObjectName third;
  third = second;
  first.reset();
  second = std::move(third);
  EXPECT_EQ(second.str(), "n2");
  second = ObjectName("other");
  EXPECT_EQ(second.str(), "other");
}

TEST(ObjectName, FitsInTheRoomOfTwoPointers) {
  // A scene may have millions.
  EXPECT_LE(sizeof(ObjectName), 16U);
}

}  // namespace
}  // namespace microtrace
