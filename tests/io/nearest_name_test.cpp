#include "base/text/nearest_name.hpp"

#include "base/text/named_items.hpp"

#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace microtrace::io {
namespace {

constexpr std::array<std::string_view, 3> kKnown{"radius", "center", "a"};

TEST(Suggestion, NamesTheNearest) {
  EXPECT_EQ(suggestion("raduis", kKnown), "; did you mean \"radius\"?");
  EXPECT_EQ(suggestion("centre", kKnown), "; did you mean \"center\"?");
  EXPECT_EQ(suggestion("Center", kKnown), "; did you mean \"center\"?");
}

TEST(Suggestion, ListsAllIfNoneIsSimilar) {
  EXPECT_EQ(suggestion("shininess", kKnown), "; known are \"radius\", \"center\", \"a\"");
  EXPECT_EQ(suggestion("b", kKnown), "; known are \"radius\", \"center\", \"a\"");
  EXPECT_EQ(suggestion("b", {}), "");
}

TEST(Suggestion, StaysShort) {
  const std::vector<std::string_view> many(1000, "radius");
  EXPECT_LT(suggestion("shininess", many).size(), 300U);
  EXPECT_LT(suggestion(std::string(10'000'000, 'x'), kKnown).size(), 100U);
}

TEST(NamedItems, AreFoundByNameFirstAndThenByIndex) {
  const std::vector<std::string> names{"front", "2", "", "back", "front"};
  EXPECT_EQ(find_item("front", names), 0U);
  EXPECT_EQ(find_item("2", names), 1U);
  EXPECT_EQ(find_item("03", names), 3U);
  for (const char* wanted : {"", "Front", "5", "-1", "1x", "99999999999999999999999"})
    EXPECT_EQ(find_item(wanted, names), std::nullopt) << wanted;
  EXPECT_EQ(find_item("0", {}), std::nullopt);
}

TEST(NamedItems, AreListedIfNoneIsSelected) {
  const std::vector<std::string> names{"front", "", "a\nb"};
  EXPECT_EQ(no_such_item("camera", "left", names),
            "there is no camera \"left\"; choose 0 (front), 1 (unnamed), 2 (a\\x0ab)");
  EXPECT_EQ(no_such_item("variant", "red", {}), "there is no variant \"red\"; the scene has none");
  const std::vector<std::string> many(1000, std::string(1000, 'x'));
  const std::string text = no_such_item("camera", "left", many);
  EXPECT_LT(text.size(), 2000U);
  EXPECT_THAT(text, testing::EndsWith(", ... 999"));
}

}  // namespace
}  // namespace microtrace::io
