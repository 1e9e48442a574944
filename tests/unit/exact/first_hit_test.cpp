/// Tests the rules of docs/exactness.md one by one, with numbers that are easy to check by hand.

#include "exact/first_hit.hpp"

#include "support/cases/counterexamples.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace microtrace::exact {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Ray ray(const Vec3& o, const Vec3& d, float t_min = 0, float t_max = kInfinity) {
  return {.o = o, .t_min = t_min, .d = d, .t_max = t_max};
}

/// Returns true if the first hit is exactly at t.
template <class Shape>
::testing::AssertionResult hits_at(float t, const Shape& shape, const Ray& ray) {
  const auto hit = first_hit(shape, ray);
  if (!hit) return ::testing::AssertionFailure() << "no hit";
  if (*hit == rational(t)) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "hits at about " << round_to_float(*hit);
}

template <class Shape>
bool misses(const Shape& shape, const Ray& ray) {
  return !first_hit(shape, ray);
}

const Triangle triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
const Vec3 down{0, 0, -1};

TEST(Exact, PublishedCounterexamplesStand) {
  for (const auto& example : adversarial::counterexamples) {
    EXPECT_EQ(first_hit(example.triangle, example.ray).has_value(), example.hit) << example.name;
  }
}

TEST(Exact, TriangleIsClosed) {
  for (const Vec3& p : {triangle.a, triangle.b, triangle.c, Vec3(2, 2, 0), Vec3(2, 0, 0)}) {
    EXPECT_TRUE(hits_at(3, triangle, ray(p + Vec3(0, 0, 3), down)));
  }
  EXPECT_TRUE(misses(triangle, ray({2, 0x1.000002p1f, 3}, down)));
  EXPECT_TRUE(misses(triangle, ray({2, -std::numeric_limits<float>::denorm_min(), 3}, down)));
}

TEST(Exact, IntervalIsClosed) {
  const Vec3 o{1, 1, 3};
  EXPECT_TRUE(hits_at(3, triangle, ray(o, down, 3, 3)));
  EXPECT_TRUE(hits_at(3, triangle, ray(o, down, 0, 3)));
  EXPECT_TRUE(hits_at(3, triangle, ray(o, down, 3)));
  EXPECT_TRUE(misses(triangle, ray(o, down, 0x1.800002p1f)));
  EXPECT_TRUE(misses(triangle, ray(o, down, 0, 0x1.7ffffep1f)));
  EXPECT_TRUE(hits_at(0, triangle, ray({1, 1, 0}, down)));
  EXPECT_TRUE(misses(triangle, ray({1, 1, 0}, down, Ray{}.t_min)));
}

TEST(Exact, CoplanarRayHitsTriangleWhereItEnters) {
  EXPECT_TRUE(hits_at(2, triangle, ray({-2, 1, 0}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(0, triangle, ray({1, 1, 0}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(0.5f, triangle, ray({1, 1, 0}, {1, 0, 0}, 0.5f)));
  EXPECT_TRUE(hits_at(1, triangle, ray({-1, 0, 0}, {1, 0, 0})));       // along an edge
  EXPECT_TRUE(hits_at(4, triangle, ray({8, -4, 0}, {-1, 1, 0})));      // through one vertex
  EXPECT_TRUE(misses(triangle, ray({-2, -1, 0}, {1, 0, 0})));          // beside the triangle
  EXPECT_TRUE(misses(triangle, ray({-2, 1, 0}, {-1, 0, 0})));          // pointing away from it
  EXPECT_TRUE(misses(triangle, ray({-2, 1, 0}, {1, 0, 0}, 0, 1.5f)));  // t_max lies before it
}

TEST(Exact, DegenerateTriangleIsItsSegmentOrPoint) {
  const Triangle segment{{0, 0, 0}, {4, 4, 0}, {1, 1, 0}};
  EXPECT_TRUE(hits_at(3, segment, ray({3, 3, 3}, down)));
  EXPECT_TRUE(hits_at(3, segment, ray({4, 4, 3}, down)));
  EXPECT_TRUE(misses(segment, ray({3, 3.5f, 3}, down)));
  EXPECT_TRUE(misses(segment, ray({5, 5, 3}, down)));
  EXPECT_TRUE(hits_at(2, segment, ray({-2, -2, 0}, {1, 1, 0})));
  EXPECT_TRUE(hits_at(0, segment, ray({2, 2, 0}, down)));
  const Triangle point{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  EXPECT_TRUE(hits_at(2, point, ray({1, 2, 5}, down)));
  EXPECT_TRUE(hits_at(0, point, ray({1, 2, 3}, down)));
  EXPECT_TRUE(misses(point, ray({1, 2, 5}, {0, 0x1p-140f, -1})));
}

TEST(Exact, Plane) {
  const Plane plane{{5, 1, 7}, {0, 2, 0}};
  EXPECT_TRUE(hits_at(2, plane, ray({0, 5, 0}, {1, -2, 0})));
  EXPECT_TRUE(misses(plane, ray({0, 5, 0}, {1, 2, 0})));
  EXPECT_TRUE(misses(plane, ray({0, 5, 0}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(0.25f, plane, ray({0, 1, 0}, {1, 0, 0}, 0.25f)));
  EXPECT_TRUE(misses(Plane{{0, 0, 0}, {0, 0, 0}}, ray({0, 0, 0}, {1, 0, 0})));
}

TEST(Exact, Disc) {
  const Disc disc{{0, 1, 0}, {0, 3, 0}, 5};
  EXPECT_TRUE(hits_at(2, disc, ray({3, 3, 4}, {0, -1, 0})));
  EXPECT_TRUE(misses(disc, ray({3, 3, 0x1.000002p2f}, {0, -1, 0})));
  EXPECT_TRUE(hits_at(2, disc, ray({-7, 1, 0}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(7, disc, ray({-7, 1, 5}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(0, disc, ray({0, 1, 0}, {1, 0, 0})));
  EXPECT_TRUE(misses(disc, ray({6, 1, 0}, {1, 0, 0})));
  EXPECT_TRUE(misses(disc, ray({-7, 2, 0}, {1, 0, 0})));  // parallel to the plane, but not in it
  EXPECT_TRUE(misses(disc, ray({-7, 1, 0x1.400002p2f}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(1, Disc{{0, 1, 0}, {0, 1, 0}, 0}, ray({0, 2, 0}, {0, -1, 0})));
  EXPECT_TRUE(misses(Disc{{0, 1, 0}, {0, 1, 0}, -1}, ray({0, 2, 0}, {0, -1, 0})));
}

TEST(Exact, SphereIsASurface) {
  const Sphere sphere{{0, 0, 0}, 3};
  EXPECT_TRUE(hits_at(2, sphere, ray({-5, 0, 0}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(8, sphere, ray({-5, 0, 0}, {1, 0, 0}, 2.5f)));
  EXPECT_TRUE(hits_at(3, sphere, ray({0, 0, 0}, {1, 0, 0})));
  EXPECT_TRUE(misses(sphere, ray({0, 0, 0}, {1, 0, 0}, 0, 2.5f)));
  EXPECT_TRUE(hits_at(5, sphere, ray({-5, 3, 0}, {1, 0, 0})));  // tangent
  EXPECT_TRUE(misses(sphere, ray({-5, 0x1.800002p1f, 0}, {1, 0, 0})));
  EXPECT_TRUE(hits_at(5, Sphere{{0, 0, 0}, 0}, ray({-5, 0, 0}, {1, 0, 0})));
  EXPECT_TRUE(misses(Sphere{{0, 0, 0}, -1}, ray({-5, 0, 0}, {1, 0, 0})));
}

TEST(Exact, EachCoefficientOfAQuadricCounts) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  EXPECT_TRUE(hits_at(3, Quadric{.a = 1, .j = -9}, ray({0, 2, 2}, x)));
  EXPECT_TRUE(hits_at(3, Quadric{.b = 1, .j = -9}, ray({2, 0, 2}, y)));
  EXPECT_TRUE(hits_at(3, Quadric{.c = 1, .j = -9}, ray({2, 2, 0}, z)));
  EXPECT_TRUE(hits_at(0.5f, Quadric{.d = 1, .j = -1}, ray({0, 2, 0}, x)));
  EXPECT_TRUE(hits_at(0.5f, Quadric{.d = 1, .j = -1}, ray({2, 0, 0}, y)));
  EXPECT_TRUE(hits_at(0.5f, Quadric{.e = 1, .j = -1}, ray({0, 0, 2}, x)));
  EXPECT_TRUE(hits_at(0.5f, Quadric{.e = 1, .j = -1}, ray({2, 0, 0}, z)));
  EXPECT_TRUE(hits_at(0.5f, Quadric{.f = 1, .j = -1}, ray({0, 0, 2}, y)));
  EXPECT_TRUE(hits_at(0.5f, Quadric{.f = 1, .j = -1}, ray({0, 2, 0}, z)));
  EXPECT_TRUE(hits_at(2, Quadric{.d = 1, .e = 1, .f = 1, .j = -12}, ray({0, 0, 0}, {1, 1, 1})));
  EXPECT_TRUE(hits_at(4, Quadric{.g = 1, .h = 2, .i = 3, .j = -24}, ray({0, 0, 0}, {1, 1, 1})));
}

TEST(Exact, QuadricWithVanishingCoefficients) {
  const Quadric paraboloid{.a = 1, .b = 1, .i = -1};
  EXPECT_TRUE(hits_at(5, paraboloid, ray({1, 2, 0}, {0, 0, 1})));
  const Quadric cone{.a = 1, .b = 1, .c = -1};
  EXPECT_TRUE(hits_at(0.5f, cone, ray({-1, 0, 0}, {1, 0, 1}, 0.25f)));
  EXPECT_TRUE(hits_at(0.75f, cone, ray({3, 4, 5}, {3, 4, 5}, 0.75f)));  // along a ruling line
  const Quadric cylinder{.a = 1, .b = 1, .j = -1};
  EXPECT_TRUE(hits_at(0, cylinder, ray({0, 1, 0}, {0, 0, 1})));
  EXPECT_TRUE(misses(cylinder, ray({0, 2, 0}, {0, 0, 1})));
  EXPECT_TRUE(hits_at(1, Quadric{}, ray({0, 2, 0}, {0, 0, 1}, 1)));
  EXPECT_TRUE(misses(Quadric{.j = 1}, ray({0, 2, 0}, {0, 0, 1}, 1)));
  const Quadric inside_out{
      .a = -1, .b = -1, .c = -1, .j = 9};  // a sphere with negative coefficients
  EXPECT_TRUE(hits_at(2, inside_out, ray({-5, 0, 0}, {1, 0, 0})));
}

TEST(Exact, ParametersBeyondFloatRoundToInfinity) {
  const Plane plane{{0, 0, -1e38f}, {0, 0, 1}};
  const auto hit = first_hit(plane, ray({0, 0, 1e38f}, {0, 0, -1e-38f}));
  ASSERT_TRUE(hit);
  EXPECT_EQ(round_to_float(*hit), kInfinity);
  EXPECT_TRUE(misses(plane, ray({0, 0, 1e38f}, {0, 0, -1e-38f}, 0, 3e38f)));
}

TEST(Exact, InvalidRaysHitNothing) {
  const Sphere sphere{{0, 0, 0}, 1};
  const Vec3 o{0, 0, 5};
  EXPECT_FALSE(misses(sphere, ray(o, down)));
  for (const Ray& invalid :
       {ray(o, {0, -0.0f, 0}), ray({0, kNan, 5}, down), ray({0, kInfinity, 5}, down),
        ray(o, {0, kNan, -1}), ray(o, {0, 0, -kInfinity}), ray(o, down, -1), ray(o, down, kNan),
        ray(o, down, 0, kNan), ray(o, down, 5, 4), ray(o, down, kInfinity, kInfinity)}) {
    EXPECT_FALSE(is_valid(invalid));
    EXPECT_TRUE(misses(sphere, invalid));
    EXPECT_TRUE(misses(triangle, invalid));
    EXPECT_TRUE(misses(Plane{}, invalid));
    EXPECT_TRUE(misses(Disc{}, invalid));
    EXPECT_TRUE(misses(Quadric{}, invalid));
  }
}

TEST(Exact, ShapesThatAreNotFiniteAreEmpty) {
  const Ray r = ray({0.25f, 0.25f, 5}, down);
  for (const float x : {kNan, kInfinity, -kInfinity}) {
    EXPECT_TRUE(misses(Triangle{{x, 0, 0}, {1, 0, 0}, {0, 1, 0}}, r));
    EXPECT_TRUE(misses(Triangle{{0, 0, 0}, {1, x, 0}, {0, 1, 0}}, r));
    EXPECT_TRUE(misses(Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, x}}, r));
    EXPECT_TRUE(misses(Plane{{x, 0, 0}, {0, 0, 1}}, r));
    EXPECT_TRUE(misses(Plane{{0, 0, 0}, {0, x, 1}}, r));
    EXPECT_TRUE(misses(Disc{{0, x, 0}, {0, 0, 1}, 1}, r));
    EXPECT_TRUE(misses(Disc{{0, 0, 0}, {x, 0, 1}, 1}, r));
    EXPECT_TRUE(misses(Disc{{0, 0, 0}, {0, 0, 1}, x}, r));
    EXPECT_TRUE(misses(Sphere{{0, 0, x}, 1}, r));
    EXPECT_TRUE(misses(Sphere{{0, 0, 0}, x}, r));
    EXPECT_TRUE(misses(Quadric{.a = 1, .b = 1, .c = 1, .f = x, .j = -1}, r));
  }
}

}  // namespace
}  // namespace microtrace::exact
