// Compares the float64 bounds of hit points on flat surfaces with exact arithmetic. Most surfaces
// are near coordinate planes, so their points have coordinates near 0.

#include "accel/spawn/dispatch.hpp"
#include "accel/spawn/origin_search.hpp"
#include "exact/first_hit.hpp"
#include "exact/implicit.hpp"
#include "exact/range.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/effort.hpp"
#include "support/reproduction.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;
using exact::Dyadic;

/// Returns a triangle on a wall or floor. It may be tilted or offset by ulps or slightly more, and
/// its coordinate may be near 0.
Triangle wall(Random& random) {
  const int axis = random.between(0, 2);
  const float at = random.one_in(3) ? 0 : random.in_cube(1).x * random.power_of_two(-40, 4);
  const float tilt = random.one_in(3) ? 0 : random.power_of_two(-60, 0);
  Triangle t{random.in_cube(4), random.in_cube(4), random.in_cube(4)};
  for (Vec3* corner : {&t.a, &t.b, &t.c}) (*corner)[axis] = at + tilt * random.symmetric();
  if (random.one_in(4)) t.b = random.jitter(t.b, 2);
  return t;
}

Case<Triangle> wall_case(Random& random) {
  const Triangle t = wall(random);
  const Vec3 target = t.a + (t.b - t.a) * static_cast<float>(random.unit() / 2) +
                      (t.c - t.a) * static_cast<float>(random.unit() / 2);
  const Vec3 o = random.in_cube(4) * random.power_of_two(-6, 6);
  return {{.o = o, .t_min = 0, .d = (target - o) * random.power_of_two(-3, 3)}, t};
}

/// Checks that rays that leave the points to either side have the same origins whether or not the
/// kernel has prepared those of one side.
void check_origins(const SpawnKernels& kernels, HitPointLanes& points) {
  constexpr Lanes kAll = (Lanes{1} << kSpawnLanes) - 1;
  const auto prepared = points;
  for (const float sign : {1.0F, -1.0F}) {
    OriginLanes lanes{}, expected{};
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < kSpawnLanes; ++i)
        lanes.direction[k][i] = expected.direction[k][i] = sign * points.d[k][i];
    }
    std::ranges::fill(points.side, 0.0F);
    const Lanes sure = kernels.find_origins(points, expected, kAll);
    ASSERT_EQ(kernels.find_origins(prepared, lanes, kAll), sure);
    if (sure == kAll) {
      ASSERT_EQ(std::memcmp(lanes.origin, expected.origin, sizeof lanes.origin), 0);
    }
    const bool is_back = sign < 0;
    ASSERT_EQ(is_back && prepared.side[0] != 0, is_back && sure == kAll);
  }
}

/// Returns the kernel's hit point if it is certain, otherwise nothing. All lanes must agree.
std::optional<Vec3> of_lanes(const SpawnKernels& kernels, const Ray& ray, const Triangle& t) {
  HitPointLanes lanes{};
  for (std::size_t i = 0; i < kSpawnLanes; ++i) {
    for (int k = 0; k < 3; ++k) {
      lanes.a[k][i] = t.a[k];
      lanes.b[k][i] = t.b[k];
      lanes.c[k][i] = t.c[k];
      lanes.o[k][i] = ray.o[k];
      lanes.d[k][i] = ray.d[k];
    }
    lanes.t_min[i] = ray.t_min;
    lanes.t_max[i] = ray.t_max;
  }
  kernels.find_hit_points(lanes);
  const auto point = [&](std::size_t i) -> std::optional<Vec3> {
    if (lanes.is_sure[i] == 0) return std::nullopt;
    return Vec3(lanes.p[0][i], lanes.p[1][i], lanes.p[2][i]);
  };
  for (std::size_t i = 1; i < kSpawnLanes; ++i) EXPECT_EQ(point(i), point(0)) << i;
  const std::optional<Vec3> result = point(0);
  if (result) check_origins(kernels, lanes);
  return result;
}

struct PointCount {
  std::size_t hits = 0, sure = 0, sure_in_lanes = 0;
};

void check(const Ray& ray, const Triangle& t, PointCount& count) {
  if (!is_filterable(ray.o) || !is_filterable(ray.d) || !is_filterable(t)) return;
  const auto exact_t = exact::first_hit(t, ray);
  if (!exact_t) return;
  const FilterResult filtered =
      TrianglePlaneFilter(t, ray.o)(DVec3(ray.d), {.t_min = ray.t_min, .t_max = ray.t_max});
  if (filtered.certainty != Certainty::hit) return;
  ++count.hits;
  const CrossProduct normal(DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.a));
  const PointOnRay point(ray, {filtered.lo, filtered.hi});
  for (int k = 0; k < 3; ++k) {
    const exact::Root x =
        exact::rational(Dyadic(ray.o[k]) * exact_t->r + Dyadic(ray.d[k]) * exact_t->p, exact_t->r);
    const auto holds = [&](double value, double error) {
      return !std::isfinite(error) || (exact::rational(Dyadic(value - error), Dyadic(1.0F)) <= x &&
                                       x <= exact::rational(Dyadic(value + error), Dyadic(1.0F)));
    };
    const Approximate in_plane = coordinate_in_plane(t.a, normal, point, k);
    ASSERT_TRUE(holds(point.value[k], point.error[k])) << reproduction(ray, t);
    ASSERT_TRUE(holds(in_plane.value, in_plane.error)) << reproduction(ray, t);
  }
  const Vec3 expected = unsigned_zeros(exact::round_point(ray, *exact_t));
  const auto is_right = [&](const std::optional<Vec3>& p) {
    return !p || std::bit_cast<std::array<std::uint32_t, 3>>(*p) ==
                     std::bit_cast<std::array<std::uint32_t, 3>>(expected);
  };
  const auto p = rounded_point(point, t.a, normal);
  ASSERT_TRUE(is_right(p)) << reproduction(ray, t);
  count.sure += p ? 1 : 0;
  const auto in_lanes = of_lanes(*kSpawnKernels.portable, ray, t);
  count.sure_in_lanes += in_lanes ? 1 : 0;
  ASSERT_TRUE(is_right(in_lanes)) << reproduction(ray, t);
  for (const SpawnKernels* kernels : kSpawnKernels.available())
    ASSERT_EQ(of_lanes(*kernels, ray, t), in_lanes) << reproduction(ray, t);
}

// The other two coordinates are known exactly, so the bound has to cover only the roundings of this
// one.
TEST(SpawnPoint, BoundsOfACoordinateInAPlaneHold) {
  Random random = traversal::announced_random(97);
  std::size_t bounded = 0;
  for (std::size_t i = 0; i < traversal::ray_count(0.2) && !HasFatalFailure(); ++i) {
    const int k = random.between(0, 2);
    // If edges are nearly parallel, the normal suffers from cancellation. The point may be near a
    // vertex or far away.
    Triangle t{random.in_cube(1), random.in_cube(1), random.in_cube(1)};
    if (random.one_in(2))
      t.c = random.jitter(t.a + (t.b - t.a) * random.symmetric(), 1 << random.between(0, 20));
    if (random.one_in(2)) t.a[k] = random.in_cube(1).x * random.power_of_two(-30, 0);
    Ray ray{.o = random.in_cube(1), .t_min = 0, .d = Vec3(0)};
    if (random.one_in(2)) ray.o = random.jitter(t.a, 1 << random.between(0, 24));
    ray.d[k] = 1;
    const CrossProduct normal(DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.a));
    PointOnRay point(ray, {.lo = 0, .hi = 0});
    point.error = DVec3(0);
    const Approximate x = coordinate_in_plane(t.a, normal, point, k);
    const exact::Implicit f(t);
    const Dyadic slope = f.slope(exact::vector(ray.o), exact::vector(ray.d));
    if (slope.sign() == 0 || !std::isfinite(x.error)) continue;
    ++bounded;
    const exact::Root expected =
        exact::rational(Dyadic(ray.o[k]) * slope - f.value(exact::vector(ray.o)), slope);
    ASSERT_LE(exact::rational(Dyadic(x.value - x.error), Dyadic(1.0F)), expected) << i;
    ASSERT_GE(exact::rational(Dyadic(x.value + x.error), Dyadic(1.0F)), expected) << i;
  }
  EXPECT_GT(bounded, traversal::ray_count(0.1));
}

TEST(SpawnPoint, BoundsHoldOnWalls) {
  Random random = traversal::announced_random(95);
  PointCount count;
  for (std::size_t i = 0; i < traversal::ray_count(0.1) && !HasFatalFailure(); ++i) {
    const auto [ray, triangle] = wall_case(random);
    check(ray, triangle, count);
  }
  EXPECT_GT(count.hits, traversal::ray_count(0.05));
  // The rays without a certain point hit at grazing angles.
  EXPECT_GT(count.sure, count.hits / 100 * 97);
  EXPECT_GT(count.sure_in_lanes, count.hits / 100 * 97);
}

TEST(SpawnPoint, BoundsHoldOnAnyTriangle) {
  Random random = traversal::announced_random(96);
  PointCount count;
  for (const TriangleKind kind : kTriangleKinds) {
    for (std::size_t i = 0; i < traversal::ray_count(0.01) && !HasFatalFailure(); ++i) {
      const auto [ray, triangle] = triangle_case(random, kind);
      check(ray, triangle, count);
    }
  }
  EXPECT_GT(count.sure, traversal::ray_count(0.02));
}

}  // namespace
}  // namespace microtrace
