#include "support/cases/adversarial_rays.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::adversarial {
namespace {

/// A vector with integer coordinates and integer length.
struct Offset {
  Vec3 vector;
  float length;
};

Offset random_offset(Random& random) {
  constexpr std::array<std::array<int, 4>, 8> quadruples{{{0, 0, 1, 1},
                                                          {0, 3, 4, 5},
                                                          {1, 2, 2, 3},
                                                          {2, 3, 6, 7},
                                                          {1, 4, 8, 9},
                                                          {4, 4, 7, 9},
                                                          {2, 6, 9, 11},
                                                          {6, 6, 7, 11}}};
  const auto& q = quadruples[static_cast<unsigned>(random.between(0, 7))];
  std::array<int, 3> v{q[0], q[1], q[2]};
  std::swap(v[0], v[static_cast<unsigned>(random.between(0, 2))]);
  std::swap(v[1], v[static_cast<unsigned>(random.between(1, 2))]);
  for (int& x : v) x *= random.one_in(2) ? 1 : -1;
  return {Vec3(v[0], v[1], v[2]), static_cast<float>(q[3])};
}

Vec3 axis(Random& random) {
  Vec3 v(0);
  v[random.between(0, 2)] = random.one_in(2) ? 1.0f : -1.0f;
  return v;
}

/// Returns an integer vector perpendicular to n. Small if n is small.
Vec3 perpendicular(Random& random, const Vec3& n) {
  return glm::cross(n, random.on_grid(3));
}

Vec3 nonzero_on_grid(Random& random, int n) {
  const Vec3 v = random.on_grid(n);
  return v == Vec3(0) ? Vec3(1, 0, 0) : v;
}

/// Returns a random length between about 2^lo and 2^hi.
float any_length(Random& random, int lo, int hi) {
  return std::abs(random.any_float(lo, hi));
}

/// A range of exponents of float32 numbers.
struct Magnitude {
  int lo, hi;
};

Magnitude any_magnitude(Random& random) {
  if (random.one_in(2)) return {-149, 127};
  const int k = random.between(-149, 115);
  return {k, k + 12};
}

Ray any_ray(Random& random, const Magnitude& of_o) {
  const Magnitude of_d = any_magnitude(random);
  return ray({random.any_vector(of_o.lo, of_o.hi), random.any_vector(of_d.lo, of_d.hi)});
}

/// Returns a ray whose origin coordinates are small multiples of `spacing`, which callers choose
/// from 2^-149 to 2^-120.
Ray subnormal_ray(Random& random, float spacing) {
  return ray({random.on_grid(9, spacing),
              random.on_grid(3, random.one_in(2) ? random.power_of_two(-149, 0) : 1)});
}

void scale(Case<Disc>& c, float s) {
  c.ray.o *= s;
  c.shape.center *= s;
  c.shape.radius *= s;
}

void scale(Case<Sphere>& c, float s) {
  c.ray.o *= s;
  c.shape.center *= s;
  c.shape.radius *= s;
}

}  // namespace

const char* name(ShapeKind kind) {
  constexpr std::array names = {"random",       "grid",       "tangent",   "on_surface",
                                "axis_aligned", "full_range", "subnormal", "special"};
  return names[static_cast<std::size_t>(kind)];
}

Case<Plane> plane_case(Random& random, ShapeKind kind) {
  const Vec3 n = nonzero_on_grid(random, 5), p = random.on_grid(9);
  const Vec3 in_plane = p + perpendicular(random, n);
  switch (kind) {
    case ShapeKind::random: {
      const Plane plane{random.in_cube(1), random.in_cube(1)};
      return {ray({random.in_cube(2), random.in_cube(1)}), plane};
    }
    case ShapeKind::grid:
      break;
    case ShapeKind::tangent: {
      const Vec3 o = random.one_in(2) ? in_plane : random.on_grid(9);
      return {ray({o, random.jitter(perpendicular(random, n), 1)}), {p, n}};
    }
    case ShapeKind::on_surface:
      return {ray({in_plane, random.on_grid(3)}), {p, n}};
    case ShapeKind::axis_aligned:
      return {ray({random.on_grid(9), axis(random)}), {p, random.one_in(2) ? axis(random) : n}};
    case ShapeKind::full_range: {
      const Magnitude m = any_magnitude(random);
      const Plane plane{random.any_vector(m.lo, m.hi), random.any_vector(-149, 127)};
      return {any_ray(random, m), plane};
    }
    case ShapeKind::subnormal: {
      const float s = random.power_of_two(-149, -120);
      return {subnormal_ray(random, s), {p * s, n * random.power_of_two(-149, 0)}};
    }
    case ShapeKind::special:
      return {ray({in_plane, perpendicular(random, n)}), {p, n}};
  }
  const float s = random.power_of_two(-20, 20);
  return {ray({random.on_grid(9, s), random.on_grid(4)}), {p * s, n}};
}

Case<Disc> disc_case(Random& random, ShapeKind kind) {
  // The point center + rim lies on the disc's rim, because rim is perpendicular to n and its length
  // is the radius.
  const auto [rim, radius] = random_offset(random);
  const Vec3 n = glm::cross(rim, nonzero_on_grid(random, 3));
  const Vec3 center = random.on_grid(9);
  Case<Disc> c{ray({random.on_grid(15), random.on_grid(4)}), {center, n, radius}};
  switch (kind) {
    case ShapeKind::random: {
      const Disc disc{random.in_cube(1), random.in_cube(1), std::abs(random.symmetric())};
      const Vec3 o = random.in_cube(2);
      return {ray({o, disc.center + random.in_cube(disc.radius) - o}), disc};
    }
    case ShapeKind::grid:
      break;
    case ShapeKind::tangent:
      c.ray.d = random.jitter(center + rim - c.ray.o, random.between(0, 1));
      break;
    case ShapeKind::on_surface:
      c.ray.o = center + rim * (static_cast<float>(random.between(-4, 4)) * 0.25f);
      break;
    case ShapeKind::axis_aligned:
      c.ray.d = axis(random);
      if (random.one_in(2)) c.shape.normal = axis(random);
      break;
    case ShapeKind::full_range: {
      const Magnitude m = any_magnitude(random);
      const Disc disc{random.any_vector(m.lo, m.hi), random.any_vector(-149, 127),
                      any_length(random, m.lo, m.hi)};
      const Ray r = any_ray(random, m);
      return {random.one_in(2) ? ray({r.o, disc.center * 0.5f - r.o * 0.5f}) : r, disc};
    }
    case ShapeKind::subnormal: {
      const float s = random.power_of_two(-149, -120);
      const Disc disc{center * s, n * random.power_of_two(-149, 0), radius * s};
      return {subnormal_ray(random, s), disc};
    }
    case ShapeKind::special: {
      const Vec3 d = random.one_in(2) ? glm::cross(n, rim) : perpendicular(random, n);
      const Vec3 start = random.one_in(2) ? rim : perpendicular(random, n);
      c.ray = ray({center + start + d * static_cast<float>(random.between(-2, 2)), d});
      break;
    }
  }
  scale(c, random.power_of_two(-20, 20));
  return c;
}

Case<Sphere> sphere_case(Random& random, ShapeKind kind) {
  const auto [offset, radius] = random_offset(random);
  const Vec3 center = random.on_grid(9);
  Case<Sphere> c{ray({random.on_grid(15), random.on_grid(4)}), {center, radius}};
  switch (kind) {
    case ShapeKind::random: {
      const Sphere sphere{random.in_cube(1), std::abs(random.symmetric())};
      const Vec3 o = random.in_cube(2);
      return {ray({o, sphere.center + random.in_cube(1.2f * sphere.radius) - o}), sphere};
    }
    case ShapeKind::grid:
      break;
    case ShapeKind::tangent: {
      const Vec3 d = perpendicular(random, offset);
      c.ray = ray({center + offset + d * static_cast<float>(random.between(-4, 2)), d});
      c.ray.d = random.jitter(d, random.between(0, 1));
      break;
    }
    case ShapeKind::on_surface:
      c.ray.o = center + offset;
      break;
    case ShapeKind::axis_aligned:
      c.ray.d = axis(random);
      break;
    case ShapeKind::full_range: {
      const Magnitude m = any_magnitude(random);
      const Sphere sphere{random.any_vector(m.lo, m.hi), any_length(random, m.lo, m.hi)};
      const Ray r = any_ray(random, m);
      return {random.one_in(2) ? ray({r.o, sphere.center * 0.5f - r.o * 0.5f}) : r, sphere};
    }
    case ShapeKind::subnormal: {
      const float s = random.power_of_two(-149, -120);
      return {subnormal_ray(random, s), {center * s, radius * s}};
    }
    case ShapeKind::special:
      c.shape.radius = 0;
      c.ray.d = center - c.ray.o;
      if (random.one_in(4)) c.ray.o = center;
      break;
  }
  scale(c, random.power_of_two(-20, 20));
  return c;
}

}  // namespace microtrace::adversarial
