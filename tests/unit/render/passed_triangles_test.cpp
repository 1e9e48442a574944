// Tests the notes of blended triangles that shadow rays pass.

#include "render/shading/transmittance.hpp"

#include <gtest/gtest.h>

namespace microtrace {
namespace {

// A triangle with references in several leaves of the tree is met several times.
TEST(PassedTriangles, CountEachTriangleOnce) {
  PassedTriangles passed;
  passed.add(3, 0.25F);
  passed.add(3, 0.25F);
  EXPECT_EQ(passed.count, 1U);
  EXPECT_EQ(passed.transmittance, 0.75F);
  passed.add(5, 0.5F);
  passed.add(3, 0.25F);
  passed.add(5, 0.5F);
  EXPECT_EQ(passed.count, 2U);
  EXPECT_EQ(passed.transmittance, 0.375F);
  passed.add(7, 0.5F);
  EXPECT_GT(passed.count, PassedTriangles::kMost);
}

}  // namespace
}  // namespace microtrace
