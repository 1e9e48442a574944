// Checks that every result of Grid equals that of Dyadic, and that Grid handles most cases with
// coordinates that occur in scenes.

#include "exact/grid.hpp"

#include "exact/first_hit.hpp"
#include "exact/implicit.hpp"
#include "exact/triangle_hit.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/reproduction.hpp"

#include <bit>
#include <cstdint>

#include <gtest/gtest.h>

namespace microtrace::exact {
namespace {

using namespace adversarial;

int sign(std::strong_ordering order) {
  return order < 0 ? -1 : order > 0;
}

bool same_bits(const Vec3& a, const Vec3& b) {
  return std::bit_cast<std::array<std::uint32_t, 3>>(a) ==
         std::bit_cast<std::array<std::uint32_t, 3>>(b);
}

class GridKinds : public ::testing::TestWithParam<TriangleKind> {
 protected:
  static constexpr int kCases = 6000;
  Random random_{300 + static_cast<std::uint64_t>(GetParam())};

  [[nodiscard]] bool is_of_a_scene() const {
    return GetParam() != TriangleKind::full_range && GetParam() != TriangleKind::subnormal;
  }
};

TEST_P(GridKinds, HitsEqualDyadic) {
  int asked = 0, known = 0;
  const auto check_on = [&](const auto& hit, const Triangle& triangle, const Ray& ray) {
    const auto root = first_hit(triangle, ray);
    ++asked;
    if (hit.found() == Found::unknown) return;
    ++known;
    ASSERT_EQ(hit.found() == Found::hit, root.has_value()) << reproduction(ray, triangle);
    if (!root) return;
    for (const double bound : {hit.bounds().lo, hit.bounds().hi}) {
      const auto order = rational(Dyadic(bound), Dyadic(1.0F)) <=> *root;
      ASSERT_TRUE(bound == hit.bounds().lo ? order <= 0 : order >= 0)
          << reproduction(ray, triangle);
    }
    if (const auto t = hit.t()) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(*t),
                std::bit_cast<std::uint32_t>(round_to_float(*root)))
          << reproduction(ray, triangle);
    }
    if (const auto p = hit.point()) {
      ASSERT_TRUE(same_bits(*p, round_point(ray, *root))) << reproduction(ray, triangle);
    }
  };
  const auto check = [&](const Triangle& triangle, const Ray& ray) {
    check_on(GridHit<2>(triangle, ray), triangle, ray);
    check_on(GridHit<3>(triangle, ray), triangle, ray);
  };
  for (int i = 0; i < kCases && !HasFatalFailure(); ++i) {
    const auto [ray, triangle] = triangle_case(random_, GetParam());
    check(triangle, ray);
    if (const auto root = first_hit(triangle, ray))
      check(triangle, with_range_near(random_, ray, round_to_float(*root)));
  }
  // Grid leaves a ray in the triangle's plane undecided if it may enter the triangle before t_min.
  if (is_of_a_scene()) {
    EXPECT_GT(known, asked * 2 / 3);
  }
}

TEST_P(GridKinds, QueriesOfOtherTrianglesEqualDyadic) {
  int known = 0;
  const auto check = [&]<int Limbs>(const GridHit<Limbs>& hit, const Triangle& triangle,
                                    const Triangle& other, const Ray& ray, const Vec3& q) {
    const auto root = first_hit(triangle, ray);
    if (!root || hit.found() != Found::hit) return;
    if (const auto side = hit.side(other)) {
      ++known;
      ASSERT_EQ(*side, Implicit(other).sign_at(ray, *root)) << reproduction(ray, triangle);
    }
    if (const auto meets = hit.meets_segment(other, q)) {
      ASSERT_EQ(*meets, meets_segment(other, q, ray, *root)) << reproduction(ray, triangle);
    }
    const auto other_root = first_hit(other, ray);
    if (const auto order = other_root ? hit.order(other) : std::nullopt) {
      ASSERT_EQ(sign(*order), sign(*root <=> *other_root)) << reproduction(ray, triangle);
    }
    const GridPlane<Limbs> plane(other);
    const Implicit f(other);
    if (const auto side = plane.side(q)) {
      ASSERT_EQ(*side, f.value(vector(q)).sign());
    }
    if (const auto slope = plane.slope(ray.d)) {
      ASSERT_EQ(*slope, f.sign_behind(ray, rational(0.0F), ray.d));
    }
    if (const auto area = plane.has_area()) {
      ASSERT_EQ(*area, nonzero_component(f.linear()) >= 0);
    }
    if (const auto n = plane.normal()) {
      for (int k = 0; k < 3; ++k) ASSERT_EQ((*n)[k], to_double(f.linear()[k]));
    }
  };
  for (int i = 0; i < kCases && !HasFatalFailure(); ++i) {
    const auto [ray, triangle] = triangle_case(random_, GetParam());
    const auto root = first_hit(triangle, ray);
    if (!root) continue;
    // The other triangle is of the same kind. It may share vertices with the first one, so that its
    // plane and edges contain the hit point.
    Triangle other = triangle_case(random_, GetParam()).shape;
    if (random_.one_in(2)) other.a = triangle.b;
    if (random_.one_in(3)) other.b = triangle.a;
    if (random_.one_in(4)) other = {triangle.c, triangle.a, random_.jitter(triangle.b, 2)};
    const Vec3 q = random_.jitter(round_point(ray, *root), 4);
    check(GridHit<2>(triangle, ray), triangle, other, ray, q);
    check(GridHit<3>(triangle, ray), triangle, other, ray, q);
  }
  if (is_of_a_scene() && GetParam() != TriangleKind::degenerate) {
    EXPECT_GT(known, kCases / 50);
  }
}

// The combination of all stages must always decide, and must always give the exact result.
TEST_P(GridKinds, HitsCombineAllStages) {
  for (int i = 0; i < kCases; ++i) {
    const auto [ray, triangle] = triangle_case(random_, GetParam());
    const auto root = first_hit(triangle, ray);
    TriangleHit hit(triangle, ray);
    ASSERT_EQ(hit.exists(), root.has_value()) << reproduction(ray, triangle);
    if (!root) continue;
    const Triangle other = {triangle.a, random_.jitter(triangle.c, 1), triangle.b};
    ASSERT_EQ(hit.t(), round_to_float(*root)) << reproduction(ray, triangle);
    ASSERT_TRUE(same_bits(hit.point(), round_point(ray, *root))) << reproduction(ray, triangle);
    ASSERT_EQ(hit.side(other), Implicit(other).sign_at(ray, *root)) << reproduction(ray, triangle);
    if (const auto other_root = first_hit(other, ray)) {
      ASSERT_EQ(sign(hit.order(other)), sign(*root <=> *other_root)) << reproduction(ray, triangle);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Grid, GridKinds, ::testing::ValuesIn(kTriangleKinds),
                         [](const auto& kind) { return name(kind.param); });

TEST(Grid, RefusesUnrepresentableCoordinates) {
  const Triangle triangle{{0, 0, 0}, {500, 0, 0}, {0, 500, 0x1.000002p-80F}};
  const Ray ray = adversarial::ray({.o = {1, 1, 1}, .d = {0, 0, -1}});
  EXPECT_EQ(GridHit<2>(triangle, ray).found(), Found::unknown);
  EXPECT_EQ(GridHit<3>(triangle, ray).found(), Found::hit);
  EXPECT_FALSE(GridPlane<2>(triangle).side({1, 1, 1}));
  const Triangle held{{0, 0, 0}, {500, 0, 0}, {0, 500, 6.1e-17F}};
  EXPECT_EQ(GridHit<2>(held, ray).found(), Found::hit);
}

// Ties between two float32 numbers must be rounded to even, both in hit points and in t.
TEST(Grid, RoundsMidpointsToEven) {
  const Triangle wall{{-8, -8, 3}, {8, -8, 3}, {0, 8, 3}};
  // x = 1 + 2^-24 (3 - 2^-24): just below the midpoint of 1 + 2^-23 and 1 + 2^-22.
  const Ray ray = adversarial::ray({.o = {1, 0, 0x1p-24F}, .d = {0x1p-24F, 0, 1}});
  const GridHit<2> hit(wall, ray);
  ASSERT_EQ(hit.found(), Found::hit);
  const auto root = first_hit(wall, ray);
  EXPECT_EQ(*hit.t(), round_to_float(*root));
  EXPECT_EQ(*hit.point(), round_point(ray, *root));
  EXPECT_EQ(*hit.point(), Vec3(1 + 0x1p-23F, 0, 3));
  // t = 3 - 3 2^-23 is the midpoint of 3 - 2^-22 and 3 - 2^-21.
  const Ray tie = adversarial::ray({.o = {0, 0, 3 * 0x1p-23F}, .d = {0, 0, 1}});
  const GridHit<2> at_tie(wall, tie);
  EXPECT_EQ(*at_tie.t(), round_to_float(*first_hit(wall, tie)));
}

}  // namespace
}  // namespace microtrace::exact
