#include "simd/lane_count.hpp"

#include <bit>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

TEST(LaneCount, IsTheNumberOfBits) {
  for (Lanes lanes = 0; lanes < 1U << 16U; ++lanes) {
    ASSERT_EQ(lane_count(lanes), std::popcount(lanes));
    ASSERT_EQ(lane_count(lanes << 16U), std::popcount(lanes));
    ASSERT_EQ(lane_count(~lanes), std::popcount(~lanes));
  }
}

}  // namespace
}  // namespace microtrace
