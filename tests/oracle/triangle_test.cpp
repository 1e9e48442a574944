/// Compares first_hit(Triangle) and first_hit(Plane) with CGAL: whether each ray hits and, for some
/// hits, the parameter and its order.

#include "exact/first_hit.hpp"
#include "exact/grid.hpp"
#include "exact/triangle_box.hpp"
#include "oracle/cgal_intersections.hpp"
#include "oracle/rounding_check.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/cases/counterexamples.hpp"
#include "support/effort.hpp"
#include "support/reproduction.hpp"

#include <optional>

#include <glm/common.hpp>
#include <gtest/gtest.h>

namespace microtrace::oracle {
namespace {

using adversarial::ShapeKind;
using adversarial::TriangleKind;
using exact::first_hit;
using exact::round_to_float;

/// A hit's parameter: the computed one, and the oracle's.
struct Parameter {
  exact::Root found;
  Rational expected;
};

Parameter parameter(const Triangle& triangle, const Ray& ray, const exact::Root& found) {
  return {found, first_parameter(triangle, ray)};
}

::testing::AssertionResult is_right(const Parameter& t) {
  const Rational found = to_rational(t.found.p) / to_rational(t.found.r);
  if (t.found.sign != 0 || t.found.r.sign() <= 0 || found != t.expected) {
    return ::testing::AssertionFailure() << "t is " << found << ", must be " << t.expected;
  }
  if (!is_enclosed(t.expected, enclose(t.found))) {
    return ::testing::AssertionFailure() << "bounds do not enclose t = " << t.expected;
  }
  const float rounded = round_to_float(t.found);
  if (!is_nearest(rounded, t.expected)) {
    return ::testing::AssertionFailure() << t.expected << " rounds to " << rounded;
  }
  return ::testing::AssertionSuccess();
}

int sign(std::strong_ordering order) {
  return order < 0 ? -1 : order > 0;
}

/// True if the fixed-width integers agree with the oracle or can't represent the numbers.
template <int Limbs>
::testing::AssertionResult is_right(const exact::GridHit<Limbs>& hit, bool is_hit) {
  using exact::Found;
  if (hit.found() == Found::unknown || (hit.found() == Found::hit) == is_hit)
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "the grid says " << !is_hit;
}

template <int Limbs>
::testing::AssertionResult is_right(const exact::GridHit<Limbs>& hit, const Rational& expected) {
  if (hit.found() != exact::Found::hit) return ::testing::AssertionSuccess();
  if (!is_enclosed(expected, hit.bounds()))
    return ::testing::AssertionFailure() << "the grid's bounds do not enclose t = " << expected;
  if (const auto t = hit.t(); t && !is_nearest(*t, expected))
    return ::testing::AssertionFailure() << "the grid rounds " << expected << " to " << *t;
  return ::testing::AssertionSuccess();
}

class TriangleKinds : public ::testing::TestWithParam<TriangleKind> {};

TEST_P(TriangleKinds, AgreesOnHitParameterAndOrder) {
  adversarial::Random random = announced_random(static_cast<std::uint64_t>(GetParam()));
  const int count = case_count(0.07);
  std::optional<Parameter> previous;
  int ray_count = 0, hit_count = 0;
  const auto check = [&](const Triangle& triangle, const Ray& ray) {
    ++ray_count;
    const auto found = first_hit(triangle, ray);
    const exact::GridHit<2> narrow(triangle, ray);
    const exact::GridHit<3> wide(triangle, ray);
    ASSERT_EQ(found.has_value(), hits(triangle, ray)) << adversarial::reproduction(ray, triangle);
    ASSERT_TRUE(is_right(narrow, found.has_value())) << adversarial::reproduction(ray, triangle);
    ASSERT_TRUE(is_right(wide, found.has_value())) << adversarial::reproduction(ray, triangle);
    if (!found || ++hit_count % 4 != 0) return;
    const Parameter t = parameter(triangle, ray, *found);
    ASSERT_TRUE(is_right(t)) << adversarial::reproduction(ray, triangle);
    ASSERT_TRUE(is_right(narrow, t.expected)) << adversarial::reproduction(ray, triangle);
    ASSERT_TRUE(is_right(wide, t.expected)) << adversarial::reproduction(ray, triangle);
    if (previous) {
      ASSERT_EQ(sign(t.found <=> previous->found), CGAL::compare(t.expected, previous->expected))
          << adversarial::reproduction(ray, triangle);
    }
    previous = t;
  };
  for (int i = 0; i < count && !HasFatalFailure(); ++i) {
    const auto [ray, triangle] = adversarial::triangle_case(random, GetParam());
    check(triangle, ray);
    const auto hit = first_hit(triangle, ray);
    if (!hit) continue;
    check(triangle, adversarial::with_range_near(random, ray, round_to_float(*hit)));
  }
  EXPECT_GT(hit_count, count / 100) << "too few hits to mean anything";
  announce(ray_count, hit_count);
}

TEST_P(TriangleKinds, AgreesOnBoxes) {
  adversarial::Random random = announced_random(50 + static_cast<std::uint64_t>(GetParam()));
  int met = 0, missed = 0;
  for (int i = 0; i < case_count(0.01) && !HasFatalFailure(); ++i) {
    const Triangle t = adversarial::triangle_case(random, GetParam()).shape;
    // Most boxes are a few steps wide, and near a corner or a point of an edge.
    const double s = random.one_in(3) ? 0 : random.unit();
    const Vec3 p(DVec3(t.a) * (1 - s) + DVec3(t.b) * s);
    const Vec3 q = random.jitter(p, 1 << random.between(0, 4)),
               r = random.one_in(8) ? t.c : random.jitter(q, 1 << random.between(0, 4));
    const Vec3 lo = glm::min(q, r), hi = glm::max(q, r);
    // CGAL 5.5 requires boxes with a volume.
    if (!(lo.x < hi.x && lo.y < hi.y && lo.z < hi.z)) continue;
    const bool expected = meets_box(t, lo, hi);
    ASSERT_EQ(exact::meets_box(t, lo, hi), expected) << i;
    ++(expected ? met : missed);
  }
  EXPECT_GT(met, case_count(0.01) / 100);
  EXPECT_GT(missed, case_count(0.01) / 100);
}

INSTANTIATE_TEST_SUITE_P(TriangleOracle, TriangleKinds,
                         ::testing::ValuesIn(adversarial::kTriangleKinds),
                         [](const auto& kind) { return adversarial::name(kind.param); });

TEST(TriangleOracle, AgreesOnPublishedCounterexamples) {
  for (const auto& example : adversarial::counterexamples) {
    EXPECT_EQ(hits(example.triangle, example.ray), example.hit) << example.name;
  }
}

class PlaneKinds : public ::testing::TestWithParam<ShapeKind> {};

TEST_P(PlaneKinds, AgreesOnHit) {
  adversarial::Random random = announced_random(100 + static_cast<std::uint64_t>(GetParam()));
  const int count = case_count(0.02);
  int ray_count = 0, hit_count = 0;
  const auto check = [&](const Plane& plane, const Ray& ray) {
    ++ray_count;
    const auto found = first_hit(plane, ray);
    ASSERT_EQ(found.has_value(), hits(plane, ray)) << adversarial::reproduction(ray, plane);
    if (found) ++hit_count;
  };
  for (int i = 0; i < count && !HasFatalFailure(); ++i) {
    const auto [ray, plane] = adversarial::plane_case(random, GetParam());
    check(plane, ray);
    const auto hit = first_hit(plane, ray);
    if (!hit) continue;
    check(plane, adversarial::with_range_near(random, ray, round_to_float(*hit)));
  }
  EXPECT_GT(hit_count, count / 100) << "too few hits to mean anything";
  announce(ray_count, hit_count);
}

INSTANTIATE_TEST_SUITE_P(PlaneOracle, PlaneKinds, ::testing::ValuesIn(adversarial::kShapeKinds),
                         [](const auto& kind) { return adversarial::name(kind.param); });

}  // namespace
}  // namespace microtrace::oracle
