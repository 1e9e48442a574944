#include "support/cases/adversarial_rays.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace microtrace::adversarial {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Barycentric coordinates: the weights of the corners b and c.
struct Barycentric {
  double u, v;
};

Barycentric inside(Random& random) {
  const double u = random.unit(), v = random.unit();
  if (u + v > 1) return {1 - u, 1 - v};
  return {u, v};
}

DVec3 point_at(const Triangle& t, const Barycentric& at) {
  return (1 - at.u - at.v) * DVec3(t.a) + at.u * DVec3(t.b) + at.v * DVec3(t.c);
}

/// Describes a ray from o to a point of a triangle. Its rounded direction is moved by up to `error`
/// ulps.
struct Aim {
  Vec3 o;
  Barycentric at;
  int error;
};

Ray aimed(Random& random, const Triangle& t, const Aim& aim) {
  return ray({aim.o, random.jitter(Vec3(point_at(t, aim.at) - DVec3(aim.o)), aim.error)});
}

const Vec3& corner(const Triangle& t, int k) {
  return k == 0 ? t.a : k == 1 ? t.b : t.c;
}

/// A random corner.
const Vec3& corner(Random& random, const Triangle& t) {
  return corner(t, random.between(0, 2));
}

Barycentric at_corner(int k) {
  return {k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
}

Case<Triangle> unit(Random& random) {
  const Triangle t{random.in_cube(1), random.in_cube(1), random.in_cube(1)};
  const Vec3 o = random.in_cube(2);
  if (random.one_in(2)) return {ray({o, random.in_cube(1)}), t};
  return {aimed(random, t, {o, inside(random), 0}), t};
}

Case<Triangle> grid(Random& random) {
  const int n = random.between(1, 6);
  const float s = random.power_of_two(-3, 3);
  const Triangle t{random.on_grid(n, s), random.on_grid(n, s), random.on_grid(n, s)};
  return {ray({random.on_grid(n, s), random.on_grid(random.between(1, 4))}), t};
}

/// A triangle at a distance of up to 2^12 times its size, and a ray origin.
struct Placed {
  Triangle triangle;
  Vec3 o;
  float distance;
};

Placed placed(Random& random) {
  const float size = random.power_of_two(-10, 10);
  const float distance = size * random.power_of_two(0, 12);
  const Vec3 m = random.in_cube(distance);
  const Triangle t{m + random.in_cube(size), m + random.in_cube(size), m + random.in_cube(size)};
  return {t, random.in_cube(distance), distance};
}

Case<Triangle> vertex(Random& random) {
  const Placed p = placed(random);
  return {aimed(random, p.triangle, {p.o, at_corner(random.between(0, 2)), random.between(0, 3)}),
          p.triangle};
}

/// Rounds v to multiples of `spacing`.
Vec3 snapped(const Vec3& v, float spacing) {
  return Vec3(std::round(v.x / spacing), std::round(v.y / spacing), std::round(v.z / spacing)) *
         spacing;
}

Case<Triangle> edge(Random& random) {
  const Placed p = placed(random);
  if (random.one_in(2)) {
    // With only a few significant bits, the point on the edge and the direction to it are
    // representable exactly.
    const float spacing = p.distance * 0x1p-10f;
    const Triangle t{snapped(p.triangle.a, spacing), snapped(p.triangle.b, spacing),
                     snapped(p.triangle.c, spacing)};
    Ray r = aimed(random, t, {random.on_grid(4096, spacing), {random.between(0, 8) / 8.0, 0}, 0});
    r.d *= random.power_of_two(-20, 20);
    return {r, t};
  }
  const double w = random.unit();
  const std::array<Barycentric, 3> at{{{w, 0}, {0, w}, {w, 1 - w}}};
  const Aim aim{p.o, at[static_cast<unsigned>(random.between(0, 2))], random.between(0, 3)};
  return {aimed(random, p.triangle, aim), p.triangle};
}

Case<Triangle> origin_on_plane(Random& random) {
  const Triangle t{random.in_cube(1), random.in_cube(1), random.in_cube(1)};
  const Vec3 o =
      random.one_in(2) ? corner(random, t) : random.jitter(Vec3(point_at(t, inside(random))), 2);
  if (random.one_in(3)) return {ray({o, (t.b - t.a) * random.symmetric()}), t};
  return {ray({o, random.in_cube(1)}), t};
}

Case<Triangle> far_from_zero(Random& random) {
  const Vec3 m = random.in_cube(random.power_of_two(0, 24));
  const Triangle t{m + random.in_cube(1), m + random.in_cube(1), m + random.in_cube(1)};
  const Vec3 o = random.one_in(4) ? Vec3(0) : m + random.in_cube(4);
  const Barycentric at = random.one_in(3) ? at_corner(random.between(0, 2)) : inside(random);
  return {aimed(random, t, {o, at, random.between(0, 2)}), t};
}

/// Scales the vector so that its largest component is 2^k.
Vec3 scaled(const DVec3& v, int k) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest > 0 ? Vec3(v / largest * std::ldexp(1.0, k)) : Vec3(0, 0, 1);
}

Case<Triangle> full_range(Random& random) {
  if (random.one_in(3)) {  // the shape's coordinates have one magnitude, the direction another
    const int k = random.between(-140, 110);
    const Triangle t{random.any_vector(k, k + 10), random.any_vector(k, k + 10),
                     random.any_vector(k, k + 10)};
    const Vec3 o = random.any_vector(k, k + 12);
    const DVec3 way = point_at(t, inside(random)) - DVec3(o);
    return {ray({o, scaled(way, random.between(-120, 120))}), t};
  }
  const auto any = [&] { return random.any_vector(-149, 127); };
  const Triangle t{any(), any(), any()};
  const Vec3 o = random.one_in(3) ? corner(random, t) : any();
  return {ray({o, any()}), t};
}

Case<Triangle> subnormal(Random& random) {
  const float s = random.power_of_two(-149, -120);
  const Triangle t{random.on_grid(9, s), random.on_grid(9, s), random.on_grid(9, s)};
  const Vec3 o = random.on_grid(9, s);
  if (random.one_in(2)) return {ray({o, corner(random, t) - o}), t};
  return {ray({o, random.on_grid(3, random.one_in(2) ? random.power_of_two(-149, 0) : 1)}), t};
}

Case<Triangle> coplanar(Random& random) {
  const int n = random.between(2, 8);
  const float s = random.power_of_two(-20, 20);
  const Vec3 m = random.on_grid(3, s), e = random.on_grid(3, s), f = random.on_grid(3, s);
  const auto direction = [&] {
    const int i = random.between(-n, n), j = random.between(-n, n);
    return static_cast<float>(i) * e + static_cast<float>(j) * f;
  };
  const Triangle t{m + direction(), m + direction(), m + direction()};
  Ray r = ray({m + direction(), direction()});
  if (random.one_in(4)) r.d = random.jitter(r.d, 1);
  return {r, t};
}

Case<Triangle> degenerate(Random& random) {
  const int n = random.between(1, 6);
  const float s = random.power_of_two(-20, 20);
  const Vec3 m = random.on_grid(3, s), e = random.on_grid(3, s);
  const auto on_line = [&] { return m + static_cast<float>(random.between(-n, n)) * e; };
  const Triangle t{on_line(), on_line(), on_line()};
  const Vec3 o = random.on_grid(6, s);
  switch (random.between(0, 3)) {
    case 0:  // through a vertex
      return {ray({o, corner(random, t) - o}), t};
    case 1:  // through any point of the line
      return {ray({o, on_line() - o}), t};
    case 2:  // along the line
      return {ray({on_line(), static_cast<float>(random.between(-3, 3)) * e}), t};
    default:
      return {ray({o, random.on_grid(3)}), t};
  }
}

Case<Triangle> sliver(Random& random) {
  const Vec3 m = random.in_cube(1), e = random.in_cube(1);
  const float height = random.power_of_two(-26, -6);
  const Triangle t{m, m + e, m + 0.5f * e + random.in_cube(height)};
  return {aimed(random, t, {random.in_cube(3), inside(random), random.between(0, 2)}), t};
}

Case<Triangle> axis_aligned(Random& random) {
  const int axis = random.between(0, 2);
  const float s = random.power_of_two(-4, 4);
  Triangle t{random.on_grid(5, s), random.on_grid(5, s), random.on_grid(5, s)};
  if (random.one_in(2)) t.b[axis] = t.c[axis] = t.a[axis];
  Vec3 d(0);
  d[axis] = random.one_in(2) ? 1.0f : -1.0f;
  if (random.one_in(3)) d[(axis + 1) % 3] = random.power_of_two(-149, 0);
  return {ray({random.on_grid(5, s), d}), t};
}

}  // namespace

const char* name(TriangleKind kind) {
  constexpr std::array names = {
      "unit",       "grid",      "vertex",   "edge",       "origin_on_plane", "far_from_zero",
      "full_range", "subnormal", "coplanar", "degenerate", "sliver",          "axis_aligned"};
  return names[static_cast<std::size_t>(kind)];
}

Case<Triangle> triangle_case(Random& random, TriangleKind kind) {
  constexpr std::array makers = {unit,          grid,        vertex,    edge,     origin_on_plane,
                                 far_from_zero, full_range,  subnormal, coplanar, degenerate,
                                 sliver,        axis_aligned};
  return makers[static_cast<std::size_t>(kind)](random);
}

Ray with_range_near(Random& random, Ray ray, float t) {
  const auto beside = [&] { return std::clamp(moved(t, random.between(-1, 1)), 0.0f, kInfinity); };
  if (!random.one_in(3)) ray.t_min = beside();
  if (!std::isfinite(ray.t_min)) ray.t_min = std::numeric_limits<float>::max();
  if (!random.one_in(3)) ray.t_max = std::max(beside(), ray.t_min);
  return ray;
}

}  // namespace microtrace::adversarial
