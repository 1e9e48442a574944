#include <microtrace/placement.hpp>

#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

TEST(Placement, FlatTransformsAreNotMirrored) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto rotation = [&] {
    return glm::rotate(DMat4(1), 3 * number(random),
                       DVec3(number(random), number(random), number(random)));
  };
  int negative = 0;
  for (int i = 0; i < 1000; ++i) {
    const DMat4 first = rotation(), last = rotation();
    for (const double size : {1.0, 1e-30, 1e30}) {
      const auto between = [&](double x, double z) {
        return Placement(first * glm::scale(DMat4(1), size * DVec3(x, 1, z)) * last);
      };
      EXPECT_FALSE(between(1, 0).is_mirrored());
      EXPECT_FALSE(between(1, 1e-6).is_mirrored());
      EXPECT_TRUE(between(-1, 1e-6).is_mirrored());
      EXPECT_TRUE(between(1, -1e-6).is_mirrored());
    }
    const DMat4 flat = first * glm::scale(DMat4(1), DVec3(1, 1, 0)) * last;
    negative += glm::determinant(glm::dmat3(flat)) < 0 ? 1 : 0;
  }
  EXPECT_GT(negative, 100);  // by rounding
}

}  // namespace
}  // namespace microtrace
