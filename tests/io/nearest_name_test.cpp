#include "base/nearest_name.hpp"

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

}  // namespace
}  // namespace microtrace::io
