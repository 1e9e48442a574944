/// Checks laws that hold for all rays and shapes.

#include "exact/first_hit.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/reproduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace::exact {
namespace {

using adversarial::Random;
using adversarial::ShapeKind;
using adversarial::TriangleKind;

constexpr std::array kKindsWithin2To60 = {TriangleKind::unit,     TriangleKind::grid,
                                          TriangleKind::vertex,   TriangleKind::edge,
                                          TriangleKind::sliver,   TriangleKind::far_from_zero,
                                          TriangleKind::coplanar, TriangleKind::degenerate};

/// Returns true if both miss, or if both hit at the same t.
::testing::AssertionResult same(const std::optional<Root>& x, const std::optional<Root>& y) {
  if (x.has_value() != y.has_value()) {
    return ::testing::AssertionFailure() << "one hits, one misses";
  }
  if (x && *x != *y) return ::testing::AssertionFailure() << "hits at different t";
  return ::testing::AssertionSuccess();
}

TEST(ExactLaws, TriangleDoesNotDependOnTheOrderOfVertices) {
  Random random(3);
  for (const TriangleKind kind : adversarial::kTriangleKinds) {
    for (int i = 0; i < 2000; ++i) {
      const auto [ray, t] = adversarial::triangle_case(random, kind);
      const auto hit = first_hit(t, ray);
      for (const Triangle& permuted :
           {Triangle{t.b, t.c, t.a}, Triangle{t.c, t.a, t.b}, Triangle{t.a, t.c, t.b},
            Triangle{t.c, t.b, t.a}, Triangle{t.b, t.a, t.c}}) {
        ASSERT_TRUE(same(hit, first_hit(permuted, ray))) << adversarial::reproduction(ray, t);
      }
    }
  }
}

TEST(ExactLaws, MirroredAndPermutedAxesHaveNoEffect) {
  Random random(4);
  const auto mirrored = [](const Vec3& v) { return Vec3(-v.y, v.z, v.x); };
  for (const TriangleKind kind : adversarial::kTriangleKinds) {
    for (int i = 0; i < 2000; ++i) {
      const auto [ray, t] = adversarial::triangle_case(random, kind);
      Ray image = ray;
      image.o = mirrored(ray.o);
      image.d = mirrored(ray.d);
      const Triangle u{mirrored(t.a), mirrored(t.b), mirrored(t.c)};
      ASSERT_TRUE(same(first_hit(t, ray), first_hit(u, image)))
          << adversarial::reproduction(ray, t);
    }
  }
}

TEST(ExactLaws, ScalingByPowersOfTwoHasNoEffect) {
  Random random(5);
  for (const TriangleKind kind : kKindsWithin2To60) {
    for (int i = 0; i < 2000; ++i) {
      const auto [ray, t] = adversarial::triangle_case(random, kind);
      const float s = random.power_of_two(-40, 60);
      Ray image = ray;
      image.o *= s;
      image.d *= s;
      ASSERT_TRUE(same(first_hit(t, ray), first_hit(Triangle{t.a * s, t.b * s, t.c * s}, image)))
          << adversarial::reproduction(ray, t);
    }
  }
}

TEST(ExactLaws, LongerDirectionDividesT) {
  Random random(6);
  for (const TriangleKind kind : kKindsWithin2To60) {
    for (int i = 0; i < 2000; ++i) {
      const auto [ray, t] = adversarial::triangle_case(random, kind);
      const float s = random.power_of_two(0, 40);
      Ray longer = ray;
      longer.d *= s;
      auto hit = first_hit(t, longer);
      if (hit) hit->p = hit->p * Dyadic(s);
      ASSERT_TRUE(same(first_hit(t, ray), hit)) << adversarial::reproduction(ray, t);
    }
  }
}

TEST(ExactLaws, HitsOfATriangleLieInItsPlane) {
  Random random(7);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto [ray, t] = adversarial::triangle_case(random, TriangleKind::grid);
    const Vec3 normal = glm::cross(t.b - t.a, t.c - t.a);  // exact for grid coordinates
    const auto hit = first_hit(t, ray);
    if (!hit || normal == Vec3(0) || glm::dot(normal, ray.d) == 0) continue;
    ++hits;
    ASSERT_TRUE(same(hit, first_hit(Plane{t.b, normal}, ray))) << adversarial::reproduction(ray, t);
  }
  EXPECT_GT(hits, 500);
}

TEST(ExactLaws, SphereIsItsQuadric) {
  Random random(8);
  int hits = 0;
  for (const ShapeKind kind : {ShapeKind::grid, ShapeKind::on_surface, ShapeKind::tangent,
                               ShapeKind::axis_aligned, ShapeKind::special}) {
    for (int i = 0; i < 4000; ++i) {
      const auto [ray, s] = adversarial::sphere_case(random, kind);
      const Vec3 c = s.center;
      const Quadric q{
          .a = 1,
          .b = 1,
          .c = 1,
          .g = -2 * c.x,
          .h = -2 * c.y,
          .i = -2 * c.z,
          .j = glm::dot(c, c) - s.radius * s.radius};  // exact for numbers with few bits
      const auto hit = first_hit(s, ray);
      ASSERT_TRUE(same(hit, first_hit(q, ray))) << adversarial::reproduction(ray, s);
      hits += hit.has_value();
    }
  }
  EXPECT_GT(hits, 4000);
}

TEST(ExactLaws, PlaneIsItsQuadric) {
  Random random(9);
  for (const ShapeKind kind : {ShapeKind::grid, ShapeKind::special, ShapeKind::tangent}) {
    for (int i = 0; i < 4000; ++i) {
      const auto [ray, p] = adversarial::plane_case(random, kind);
      const Vec3 n = p.normal;
      const Quadric q{.g = n.x, .h = n.y, .i = n.z, .j = -glm::dot(n, p.point)};
      ASSERT_TRUE(same(first_hit(p, ray), first_hit(q, ray))) << adversarial::reproduction(ray, p);
    }
  }
}

/// Returns true if the ray's point at t lies in the plane.
bool is_in_plane_at(float t, const Plane& plane, Ray ray) {
  ray.t_min = ray.t_max = t;
  return first_hit(plane, ray).has_value();
}

TEST(ExactLaws, TransversalHitsOfADiscAreThoseOfItsPlane) {
  Random random(10);
  int hits = 0;
  for (const ShapeKind kind : {ShapeKind::random, ShapeKind::tangent, ShapeKind::full_range}) {
    for (int i = 0; i < 2000; ++i) {
      const auto [ray, disc] = adversarial::disc_case(random, kind);
      const Plane plane{disc.center, disc.normal};
      const auto hit = first_hit(disc, ray);
      if (!hit || (is_in_plane_at(1, plane, ray) && is_in_plane_at(2, plane, ray))) continue;
      ++hits;
      ASSERT_TRUE(same(hit, first_hit(plane, ray))) << adversarial::reproduction(ray, disc);
      Disc larger = disc;
      larger.radius = std::nextafter(disc.radius, std::numeric_limits<float>::max());
      ASSERT_TRUE(same(hit, first_hit(larger, ray))) << adversarial::reproduction(ray, disc);
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(ExactLaws, NarrowingTheIntervalAroundTheHitKeepsIt) {
  Random random(11);
  for (const ShapeKind kind : adversarial::kShapeKinds) {
    for (int i = 0; i < 2000; ++i) {
      const auto [ray, sphere] = adversarial::sphere_case(random, kind);
      const auto hit = first_hit(sphere, ray);
      if (!hit) continue;
      const float t = round_to_float(*hit);
      Ray narrow = ray;
      narrow.t_min =
          std::min(std::max(std::nextafter(t, -1.0f), 0.0f), std::numeric_limits<float>::max());
      narrow.t_max = std::nextafter(t, std::numeric_limits<float>::infinity());
      ASSERT_TRUE(same(hit, first_hit(sphere, narrow))) << adversarial::reproduction(ray, sphere);
    }
  }
}

}  // namespace
}  // namespace microtrace::exact
