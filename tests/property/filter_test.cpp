// Checks that every certain filter result equals the exact answer, and that every interval contains
// the exact t.

#include "accel/filters/shape_filter.hpp"
#include "exact/first_hit.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/reproduction.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

constexpr int kCasesPerKind = 40000;

exact::Root number(double t) {
  return exact::rational(exact::Dyadic(t), exact::Dyadic(1.0F));
}

struct FilterCount {
  int asked = 0, certain = 0;
  [[nodiscard]] double share() const { return asked == 0 ? 1 : double{1} * certain / asked; }
};

template <class S>
void check(const Ray& ray, const S& shape, FilterCount& count) {
  if (!exact::is_valid(ray) || !is_filterable(ray.o) || !is_filterable(ray.d) ||
      !is_filterable(shape))
    return;
  const FilterResult filtered =
      seen_from(ray.o, shape)(DVec3(ray.d), {.t_min = ray.t_min, .t_max = ray.t_max});
  const auto root = exact::first_hit(shape, ray);
  ++count.asked;
  if (filtered.certainty != Certainty::unsure) {
    ++count.certain;
    ASSERT_EQ(filtered.certainty == Certainty::hit, root.has_value()) << reproduction(ray, shape);
  }
  if (!root) return;
  if (std::isfinite(filtered.lo)) {
    ASSERT_LE(number(filtered.lo), *root) << reproduction(ray, shape);
  }
  if (filtered.certainty == Certainty::hit) {
    ASSERT_GE(number(filtered.hi), *root) << reproduction(ray, shape);
    // The interval is nearly always narrow enough to round t immediately.
    ASSERT_TRUE(std::isfinite(filtered.hi)) << reproduction(ray, shape);
  }
}

// Checks each case unchanged, and with the ends of the ray's interval at the hit or one ulp away.
template <class MakeCase>
FilterCount check_kind(std::uint64_t seed, MakeCase make_case) {
  Random random(seed);
  FilterCount count;
  for (int i = 0; i < kCasesPerKind && !testing::Test::HasFatalFailure(); ++i) {
    const auto [ray, shape] = make_case(random);
    check(ray, shape, count);
    if (i % 4 != 0) continue;
    FilterCount ignored;
    if (const auto root = exact::first_hit(shape, ray))
      check(with_range_near(random, ray, exact::round_to_float(*root)), shape, ignored);
  }
  return count;
}

TEST(Filter, Triangle) {
  for (const TriangleKind kind : kTriangleKinds) {
    SCOPED_TRACE(name(kind));
    const FilterCount count =
        check_kind(1, [&](Random& random) { return triangle_case(random, kind); });
    if (kind == TriangleKind::unit) {
      EXPECT_GT(count.share(), 0.9999);
    }
  }
}

// Rays hit points and ends of segments exactly, although a - o needs more bits than float64 has.
TEST(Filter, TriangleWithoutAreaWithRoundedOffset) {
  Random random(3);
  FilterCount count;
  for (int i = 0; i < kCasesPerKind && !testing::Test::HasFatalFailure(); ++i) {
    const Vec3 d = random.on_grid(15);
    if (d == Vec3(0)) continue;
    const auto number = [&] { return static_cast<float>(random.between(1, 0xFFFFF)); };
    const Vec3 a = number() * random.power_of_two(-70, -20) * d, b = random.in_cube(1);
    const Ray ray{.o = number() * d, .t_min = 0, .d = -d};
    ASSERT_TRUE(exact::first_hit(Triangle{a, a, a}, ray));
    check(ray, Triangle{a, a, a}, count);
    check(ray, Triangle{b, a, a}, count);
  }
}

template <class MakeCase>
void check_all_kinds(MakeCase make_case) {
  for (const ShapeKind kind : kShapeKinds) {
    SCOPED_TRACE(name(kind));
    const FilterCount count =
        check_kind(2, [&](Random& random) { return make_case(random, kind); });
    if (kind == ShapeKind::random) {
      EXPECT_GT(count.share(), 0.999);
    }
  }
}

TEST(Filter, Sphere) {
  check_all_kinds(sphere_case);
}
TEST(Filter, Plane) {
  check_all_kinds(plane_case);
}
TEST(Filter, Disc) {
  check_all_kinds(disc_case);
}
TEST(Filter, Quadric) {
  check_all_kinds(quadric_case);
}

}  // namespace
}  // namespace microtrace
