// Checks the order of nested media.

#include "render/media/nested_media.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// The media from the inside out, as indices.
std::vector<int> indices(const NestedMedia* media, const Medium* first) {
  std::vector<int> result;
  for (; media != nullptr; media = media->outer)
    result.push_back(static_cast<int>(media->medium - first));
  return result;
}

class NestedMediaTest : public testing::Test {
 protected:
  std::vector<int> cross(int own, bool front) {
    const Beyond beyond = table_.cross(&media_[static_cast<std::size_t>(own)], front, here_);
    outside_ = beyond.outside == nullptr ? -1 : static_cast<int>(beyond.outside - media_.data());
    here_ = beyond.media;
    return indices(here_, media_.data());
  }
  bool is_hidden(int own, bool front) {
    return NestedMediaTable::is_hidden(&media_[static_cast<std::size_t>(own)], front, here_);
  }
  using Indices = std::vector<int>;

  std::array<Medium, 12> media_;
  NestedMediaTable table_;
  const NestedMedia* here_ = nullptr;
  int outside_ = -1;
};

TEST_F(NestedMediaTest, LeavingABodyRestoresTheMediumAroundIt) {
  EXPECT_EQ(cross(0, true), Indices({0}));
  EXPECT_EQ(outside_, -1);
  const NestedMedia* in_glass = here_;
  EXPECT_EQ(cross(1, true), Indices({1, 0}));
  EXPECT_EQ(outside_, 0);
  EXPECT_EQ(cross(2, true), Indices({2, 1, 0}));
  EXPECT_EQ(cross(2, false), Indices({1, 0}));
  EXPECT_EQ(outside_, 1);
  EXPECT_EQ(cross(1, false), Indices({0}));
  EXPECT_EQ(here_, in_glass) << "each combination is stored once";
  EXPECT_EQ(cross(0, false), Indices());
  EXPECT_EQ(outside_, -1);
}

TEST_F(NestedMediaTest, ThinWallsChangeNothing) {
  cross(3, true);
  EXPECT_EQ(table_.cross(nullptr, true, here_).media, here_);
  EXPECT_EQ(table_.cross(nullptr, false, nullptr).media, nullptr);
}

TEST_F(NestedMediaTest, OverlappingBodies) {
  cross(0, true);
  cross(1, true);
  EXPECT_TRUE(is_hidden(0, false));
  EXPECT_FALSE(is_hidden(1, false)) << "the current body";
  EXPECT_FALSE(is_hidden(0, true)) << "another body of this medium";
  EXPECT_FALSE(is_hidden(2, false)) << "the camera may be in a body";
  EXPECT_EQ(indices(table_.without(here_, media_[0]), media_.data()), Indices({1}));
  EXPECT_EQ(cross(1, true), Indices({1, 1, 0}));
  EXPECT_FALSE(is_hidden(1, false));
  EXPECT_EQ(cross(1, false), Indices({1, 0}));
  EXPECT_EQ(outside_, 1);
}

// A path that starts inside a body leaves it to what it believes to be around it.
TEST_F(NestedMediaTest, BodyThatWasNotEntered) {
  EXPECT_EQ(cross(0, false), Indices());
  EXPECT_EQ(outside_, -1);
  cross(1, true);
  EXPECT_EQ(cross(0, false), Indices({1}));
  EXPECT_EQ(outside_, 1);
}

TEST_F(NestedMediaTest, DeepNestingForgetsTheOutermostMedium) {
  for (int i = 0; i < 8; ++i) cross(i, true);
  EXPECT_EQ(cross(8, true), Indices({8, 7, 6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(outside_, 7);
  EXPECT_EQ(cross(8, false), Indices({7, 6, 5, 4, 3, 2, 1}));
  table_.clear();
  here_ = nullptr;
  EXPECT_EQ(cross(9, true), Indices({9}));
}

}  // namespace
}  // namespace microtrace
