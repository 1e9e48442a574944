// Tests each filter with inputs for which nearly all roundings have the same sign. If the error
// bound were halved, the filter would return a certain but wrong result. The inputs were found by
// search. mutations.py verifies that each bound has such an input.

#include "accel/filters/shape_filter.hpp"
#include "accel/spawn/box_clearance.hpp"
#include "exact/first_hit.hpp"
#include "exact/numbers/vector.hpp"
#include "support/reproduction.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

template <int N>
using Numbers = std::array<float, N>;

Vec3 vec3(const auto& numbers, std::size_t i) {
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}
exact::Vector vector(const auto& numbers, std::size_t i) {
  return exact::vector(vec3(numbers, i));
}
exact::Root number(double t) {
  return exact::rational(exact::Dyadic(t), exact::Dyadic(1.0F));
}
// Returns the signed area of the parallelogram spanned by ab and ap, projected along the z axis.
exact::Dyadic area(const exact::Vector& a, const exact::Vector& b, const exact::Vector& p) {
  return cross(b - a, p - a).z;
}

int sign_at(const Quadric& q, const exact::Vector& p) {
  const exact::Dyadic a(q.a), b(q.b), c(q.c), d(q.d), e(q.e), f(q.f), g(q.g), h(q.h), i(q.i),
      j(q.j);
  return (a * p.x * p.x + b * p.y * p.y + c * p.z * p.z + d * p.x * p.y + e * p.x * p.z +
          f * p.y * p.z + g * p.x + h * p.y + i * p.z + j)
      .sign();
}

void expect_holds(const Approximate& bounds, const exact::Dyadic& value) {
  const exact::Dyadic difference = exact::Dyadic(bounds.value) - value, error(bounds.error);
  EXPECT_LE(compare(difference, error), 0);
  EXPECT_LE(compare(-error, difference), 0);
}

void expect_holds(const FilterResult& filtered, const exact::Root& t) {
  ASSERT_TRUE(std::isfinite(filtered.lo) && std::isfinite(filtered.hi));
  EXPECT_LE(number(filtered.lo), t);
  EXPECT_GE(number(filtered.hi), t);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kEverywhere{.t_min = -kInfinity, .t_max = kInfinity};

// Checks that results marked as certain are correct, and that bounds hold.
template <class S>
void check(const S& shape, const Vec3& o, const Vec3& d) {
  const Ray ray{.o = o, .t_min = 0, .d = d};
  SCOPED_TRACE(adversarial::reproduction(ray, shape));
  const FilterResult filtered = seen_from(o, shape)(DVec3(d), {.t_min = 0, .t_max = kInfinity});
  const auto root = exact::first_hit(shape, ray);
  if (filtered.certainty != Certainty::unsure) {
    EXPECT_EQ(filtered.certainty == Certainty::hit, root.has_value());
  }
  if (!root) return;
  EXPECT_LE(number(filtered.lo), *root);
  EXPECT_GE(number(filtered.hi), *root);
}

TEST(Bounds, DotProduct) {
  const Numbers<6> v = {0x1p+1F, -0x1.00000ap+1F, 0x1.00000ap-1F, -0x1p+0F, 0x1p-53F, -0x1.cp-49F};
  expect_holds(dot_product(DVec3(vec3(v, 0)), DVec3(vec3(v, 3)), 3),
               dot(vector(v, 0), vector(v, 3)));
}

TEST(Bounds, Quotient) {
  constexpr std::array<double, 3> v = {0x1.000009dda76bdp+0, 0x1.00000482fed74p+0,
                                       0x1.ffe24557bba92p-53};
  const exact::Dyadic n(v[0]), d(v[1]), error(v[2]);
  const FilterResult filtered = result_of(
      quotient_result({.value = v[0], .error = v[2]}, {.value = v[1], .error = 0}, kEverywhere));
  expect_holds(filtered, exact::rational(n - error, d));
  expect_holds(filtered, exact::rational(n + error, d));
}

TEST(Bounds, QuotientOfErrors) {
  // The extreme quotients are (4 + 1) / (8 - 1) and (4 - 1) / (8 + 1).
  const FilterResult filtered =
      result_of(quotient_result({.value = 4, .error = 1}, {.value = 8, .error = 1}, kEverywhere));
  expect_holds(filtered, exact::rational(exact::Dyadic(5.0F), exact::Dyadic(7.0F)));
  expect_holds(filtered, exact::rational(exact::Dyadic(3.0F), exact::Dyadic(9.0F)));
}

TEST(Bounds, SquareRoot) {
  const Approximate rounded = square_root<1>({.value = 0x1.0000000059311p+0, .error = 0});
  const exact::Dyadic least(rounded.value - rounded.error), most(rounded.value + rounded.error);
  EXPECT_LE(compare(least * least, exact::Dyadic(0x1.0000000059311p+0)), 0);
  EXPECT_GE(compare(most * most, exact::Dyadic(0x1.0000000059311p+0)), 0);
  // The bounds must contain the square root of 1 - 1/4.
  const Approximate root = square_root<1>({.value = 1, .error = 0.25});
  const exact::Dyadic below(root.value - root.error);
  EXPECT_LE(compare(below * below, exact::Dyadic(0.75)), 0);
}

TEST(Bounds, FirstRoot) {
  // The coefficients a and b, the square root of the discriminant, and the error of b.
  constexpr std::array<double, 4> v = {0x1.000009dfe11d7p+0, -0x1.00000cef4faafp+0,
                                       0x1.120fea3088868p-41, 0x1.f9dad477ac838p-55};
  const exact::Dyadic a(v[0]), numerator = -exact::Dyadic(v[1]) - exact::Dyadic(v[2]), error(v[3]);
  const FilterResult filtered =
      result_of(first_root_result<1>({.value = v[0], .error = 0}, {.value = v[1], .error = v[3]},
                                     {.value = v[2], .error = 0}, kEverywhere));
  expect_holds(filtered, exact::rational(numerator - error, a));
  expect_holds(filtered, exact::rational(numerator + error, a));
}

TEST(Bounds, TrianglePlane) {
  constexpr std::array<Numbers<15>, 2> cases = {{
      {-0x1.fd64a6p+1F, -0x1.00000ap+1F, 0x1.a1c4d4p-50F, 0x1.85e20cp+3F, -0x1.6ec348p+1F,
       0x1.0ab9ecp+0F, 0x1.5ed06p-25F, -0x1.700398p-48F, -0x1.7e571ap-47F, -0x1.6c0026p-46F,
       0x1.740046p-46F, -0x1.6p-49F, -0x1.85e20ep+6F, 0x1.c50b92p+0F, 0x1.2a265ep+0F},
      {-0x1.e08b9cp-50F, -0x1.c08b6cp-54F, -0x1.fffaeep-53F, -0x1.9aaaa2p-47F, 0x1.37aa74p-3F,
       -0x1.600004p-22F, -0x1.7f2ffap+0F, -0x1.5c43ccp-22F, 0x1.deff36p-23F, 0x1.13043cp+0F,
       0x1.9ee56ep-51F, 0x1.c2abb2p-58F, 0x1.ff9bf8p+0F, -0x1.21445ep-3F, 0x1.ap-50F},
  }};
  for (const auto& v : cases) {  // vertices, o, d
    const exact::Vector a = vector(v, 0), n = cross(vector(v, 3) - a, vector(v, 6) - a);
    const TrianglePlaneFilter filter({vec3(v, 0), vec3(v, 3), vec3(v, 6)}, vec3(v, 9));
    expect_holds(filter(DVec3(vec3(v, 12)), kEverywhere),
                 exact::rational(dot(a - vector(v, 9), n), dot(vector(v, 12), n)));
  }
}

TEST(Bounds, Plane) {
  constexpr std::array<Numbers<12>, 1> cases = {{
      {-0x1.c0664ep-54F, -0x1.000bb8p-1F, 0x1.7dc79ep-3F, -0x1.714efcp-21F, 0x1.29df72p-1F,
       0x1.8e962ap+0F, -0x1.444p-2F, 0x1.bffc6p-52F, -0x1.800a5cp-55F, 0x1.c99bfap-3F,
       -0x1.fe239ap-55F, -0x1.17e48ep-51F},
  }};
  for (const auto& v : cases) {  // point, normal, o, d
    const SeenPlane plane = plane_seen_from(vec3(v, 6), vec3(v, 0), vec3(v, 3));
    expect_holds(result_of(filter(plane, DVec3(vec3(v, 9)), kEverywhere)),
                 exact::rational(dot(vector(v, 3), vector(v, 0) - vector(v, 6)),
                                 dot(vector(v, 3), vector(v, 9))));
  }
}

TEST(Bounds, Disc) {
  constexpr std::array<Numbers<13>, 1> cases = {{
      {-0x1.ffde5cp-54F, 0x0p+0F, -0x1.ff3f0ep-28F, 0x0p+0F, 0x1.bfea9cp-53F, -0x1.83dac8p-52F,
       0x1.00acf8p+0F, -0x1.00acf8p+0F, 0x1.398ecp-26F, -0x1.0001f6p-27F, 0x1.498a2ap-27F,
       -0x1.ep-56F, 0x1.d2d02ep-1F},
  }};
  for (const auto& v : cases)  // center, normal, radius, o, d
    check(Disc{vec3(v, 0), vec3(v, 3), v[6]}, vec3(v, 7), vec3(v, 10));
}

TEST(Bounds, Sphere) {
  constexpr std::array<Numbers<10>, 4> cases = {{
      {-0x1p-50F, 0x1.003bdap+1F, -0x1.002604p-52F, 0x1.003bdap+1F, -0x1.e824dep-27F,
       0x1.003bdap+1F, 0x1.003bdap+1F, 0x1.8d2288p+4F, 0x1.fff8a4p-23F, -0x1.fff8a4p-23F},
      {0x1.b19da6p-56F, -0x1.ff172ap-54F, 0x0p+0F, 0x1.02004ap+0F, 0x1.6a1b22p-27F, -0x1.02004ap+0F,
       0x1.6a11f8p-27F, 0x0p+0F, -0x1.04a23cp-2F, -0x1.7fbffap-24F},
      {-0x1.dffd5cp-49F, 0x1.fffff8p-28F, 0x1.fffffcp-26F, 0x1.c00efp-24F, -0x1.1fd946p+1F,
       -0x1.600b68p-24F, 0x1.51ab6ep-53F, 0x1.d18be8p+1F, 0x1p-25F, -0x1.ffff04p-26F},
      {-0x1.0315aep-30F, -0x1.0dc762p-49F, -0x1.05cf7cp-53F, 0x1.f24558p-7F, 0x1.1d6274p+0F,
       -0x1.3fffccp-19F, 0x1.009bfap-30F, -0x1.000006p-2F, -0x1.e10018p-26F, 0x1.e0fcdp-26F},
  }};
  for (const auto& v : cases)  // center, radius, o, d
    check(Sphere{vec3(v, 0), v[3]}, vec3(v, 4), vec3(v, 7));
}

TEST(Bounds, Quadric) {
  constexpr Numbers<16> v = {0x1.04ecc6p+0F,   0x1.8p-49F,      0x1.731f2p-52F,   0x1.2b12fap+0F,
                             0x1.198bfp-51F,   0x1.20b52cp-2F,  0x1.1d87aep-49F,  -0x1.e7ca26p+0F,
                             -0x1.a233cp-51F,  0x1.1d2d96p-53F, 0x1.fdaee6p-1F,   0x1.71090ap-53F,
                             -0x1.7ffff6p-51F, -0x1.034e42p+0F, -0x1.5febe2p-52F, 0x1.04ecb2p+0F};
  check(Quadric{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9]}, vec3(v, 10),
        vec3(v, 13));
}

TEST(Bounds, SideOfATriangle) {
  constexpr Numbers<12> v = {0x1.26025p+10F,   0x1.0bfe58p-7F,   0x1.2bc184p-2F,
                             -0x1.b740fcp-44F, -0x1.b74104p-44F, 0x1.2e49a2p-56F,
                             -0x1.9407f8p+10F, 0x1.c03d04p+19F,  0x1.68796p-2F,
                             0x1.f745p-44F,    0x1.604586p-35F,  0x1.ae34p-54F};  // vertices, point
  const Triangle t{vec3(v, 0), vec3(v, 3), vec3(v, 6)};
  const exact::Vector a = vector(v, 0);
  const int side = dot(vector(v, 9) - a, cross(vector(v, 3) - a, vector(v, 6) - a)).sign();
  EXPECT_NE(certain_side(t.a, normal_of(t), DVec3(vec3(v, 9)), DVec3(0)), -side);
}

TEST(Bounds, SideOfABox) {
  // The plane x = 0 cuts the larger box around (1, 0, 0), but not the smaller one.
  const Triangle t{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(certain_side(t.a, normal_of(t), DVec3(1, 0, 0), DVec3(0.75)), 1);
  EXPECT_EQ(certain_side(t.a, normal_of(t), DVec3(1, 0, 0), DVec3(1.25)), 0);
}

TEST(Bounds, CoordinateInAPlane) {
  constexpr Numbers<11> v = {
      -0x1.000006p+1F, -0x1.0013f2p+1F,  0x1.a07adep-19F,  -0x1.dfff3ep-49F,
      0x1.dfff22p-49F, -0x1.ef7ca2p-51F, -0x1.fff382p-24F, 0x1.000006p+1F,
      -0x1p-1F,        0x1.dfff3ap-49F,  -0x1.dfff3ap-49F};  // vertices, x, y
  const Triangle t{vec3(v, 0), vec3(v, 3), vec3(v, 6)};
  const Ray ray{.o = {v[9], v[10], 0}, .d = Vec3(0)};
  const Approximate z = coordinate_in_plane(t.a, normal_of(t), {ray, {.lo = 1, .hi = 1}}, 2);
  const exact::Vector a = vector(v, 0), n = cross(vector(v, 3) - a, vector(v, 6) - a),
                      from_a = exact::vector(ray.o) - a;
  const exact::Root expected = exact::rational(a.z * n.z - n.x * from_a.x - n.y * from_a.y, n.z);
  // Uses exact numbers, because float64 would round the ends of the interval once more.
  EXPECT_LE(exact::rational(exact::Dyadic(z.value) - exact::Dyadic(z.error), 1.0F), expected);
  EXPECT_GE(exact::rational(exact::Dyadic(z.value) + exact::Dyadic(z.error), 1.0F), expected);
}

TEST(Bounds, AreaSeenAlongAnAxis) {
  constexpr Numbers<9> v = {-0x1.600014p-50F, 0x1.5ffe1ap-51F,  -0x1.88561ap-3F,
                            0x1.fffe06p-2F,   -0x1.000002p-1F,  -0x1.fffdfep-5F,
                            -0x1.19946ap+0F,  -0x1.5ffd4ep-51F, 0x1.5ffe1ap-51F};  // a, b, p
  expect_holds(area_along(2, vec3(v, 0), vec3(v, 3), DVec3(vec3(v, 6)), DVec3(0)),
               area(vector(v, 0), vector(v, 3), vector(v, 6)));
  // The box around p has p + (0.5, 0.5, 0) as a corner.
  const Approximate beside = area_along(2, {0, 0, 0}, {1, -2, 0}, {3, 5, 0}, DVec3(0.5));
  const Vec3 zero(0), b(1, -2, 0), p(3.5F, 5.5F, 0);
  expect_holds(beside, area(exact::vector(zero), exact::vector(b), exact::vector(p)));
}

TEST(Bounds, Ball) {
  constexpr Numbers<7> v = {0x1.001ffap-10F, 0x1.100002p+0F, 0x1.93d302p-57F, 0x1.001ffep-10F,
                            0x1.2fadeap-54F, 0x1.c0034p-51F, 0x1.001ffep-10F};  // center, radius, p
  const exact::Vector m = vector(v, 4) - vector(v, 0);
  const exact::Dyadic r(v[3]);
  expect_holds(ball_value(vec3(v, 0), v[3], DVec3(vec3(v, 4)), DVec3(0)), dot(m, m) - r * r);
  // The box extends by 1 from (3, 4, 5) along each axis. The second box is around the ball's
  // center.
  expect_holds(ball_value(Vec3(0), 1, {3, 4, 5}, DVec3(1)), exact::Dyadic(16.0F + 25 + 36 - 1));
  expect_holds(ball_value(Vec3(0), 1, {0, 0, 0}, DVec3(1)), exact::Dyadic(3.0F - 1));
}

TEST(Bounds, QuadricPassingABox) {
  constexpr Numbers<14> v = {0x1p+0F,          -0x1.fff1dep-54F, 0x1.2p-50F,       -0x1.80027p-52F,
                             0x1.0e23c2p-2F,   -0x1.0e064p-2F,   -0x1.fff16cp-54F, 0x1.00008p+0F,
                             0x1.0ae40ep-2F,   0x1.27f8eap-52F,  0x1.00008p+0F,    -0x1.00008p+0F,
                             -0x1.e39592p-52F, 0x1.7f909cp-57F};  // coefficients, p, radius
  const Quadric q{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9]};
  if (clears_box(q, DVec3(vec3(v, 10)), DVec3(v[13]))) {
    const int side = sign_at(q, vector(v, 10));
    for (unsigned corner = 0; corner < 8; ++corner) {
      exact::Vector x = vector(v, 10);
      x.x = x.x + exact::Dyadic((corner & 1U) != 0 ? v[13] : -v[13]);
      x.y = x.y + exact::Dyadic((corner & 2U) != 0 ? v[13] : -v[13]);
      x.z = x.z + exact::Dyadic((corner & 4U) != 0 ? v[13] : -v[13]);
      EXPECT_EQ(sign_at(q, x), side) << corner;
    }
  }
  // The quadric is zero at a corner of the box: x y + x + y = 3 at (1, 1), and x^2 = 4 at 2.
  EXPECT_FALSE(
      clears_box(Quadric{.d = 1, .g = 1, .h = 1, .j = -3}, DVec3(0.5, 0.5, 0), DVec3(0.5)));
  EXPECT_FALSE(clears_box(Quadric{.a = 1, .j = -4}, DVec3(1, 0, 0), DVec3(1)));
}

}  // namespace
}  // namespace microtrace
