#include "support/cases/adversarial_rays.hpp"

#include <glm/geometric.hpp>

namespace microtrace::adversarial {
namespace {

/// Returns a quadric with coefficients drawn by `draw`. Some of the ten are omitted.
template <class Draw>
Quadric drawn(Random& random, Draw draw) {
  Quadric q;
  for (float* x : {&q.a, &q.b, &q.c, &q.d, &q.e, &q.f, &q.g, &q.h, &q.i, &q.j}) {
    if (!random.one_in(4)) *x = draw();
  }
  return q;
}

/// Returns the left-hand side of the quadric's equation. Exact for small integers.
float value(const Quadric& q, const Vec3& p) {
  return q.a * p.x * p.x + q.b * p.y * p.y + q.c * p.z * p.z + q.d * p.x * p.y + q.e * p.x * p.z +
         q.f * p.y * p.z + q.g * p.x + q.h * p.y + q.i * p.z + q.j;
}

/// Returns the quadric of the sphere with center c and squared radius r2. Exact for small integers.
Quadric sphere(const Vec3& c, float r2) {
  return {.a = 1,
          .b = 1,
          .c = 1,
          .g = -2 * c.x,
          .h = -2 * c.y,
          .i = -2 * c.z,
          .j = glm::dot(c, c) - r2};
}

/// A quadric and a line whose intersection has no t^2 term.
struct Ruled {
  Quadric quadric;
  Vec3 direction, on_line;
};

Ruled random_ruled(Random& random) {
  const Quadric cone{.a = 1, .b = 1, .c = -1};
  const Quadric paraboloid{.a = 1, .b = 1, .i = -1};
  const Quadric cylinder{.a = 1, .b = 1, .j = -1};
  const Quadric saddle{.d = 1, .i = -1};
  const Quadric one_sheet{.a = 1, .b = 1, .c = -1, .j = -1};
  const Quadric plane{.g = 1, .h = 2, .i = -3, .j = 1};
  const std::array<Ruled, 9> ruled{{{cone, {3, 4, 5}, {0, 0, 0}},
                                    {cone, {5, -12, 13}, {1, 0, 1}},
                                    {paraboloid, {0, 0, 1}, {1, 2, 5}},
                                    {cylinder, {0, 0, -2}, {0, 1, 0}},
                                    {saddle, {1, 0, 3}, {0, 3, 0}},
                                    {one_sheet, {0, 1, 1}, {1, 0, 0}},
                                    {one_sheet, {3, 4, -5}, {1, 0, 0}},
                                    {plane, {1, 1, 1}, {2, 0, 1}},
                                    {Quadric{}, {1, 2, 3}, {1, 1, 1}}}};
  return ruled[static_cast<unsigned>(random.between(0, 8))];
}

}  // namespace

Case<Quadric> quadric_case(Random& random, ShapeKind kind) {
  const auto small = [&] { return static_cast<float>(random.between(-4, 4)); };
  const Quadric grid = drawn(random, small);
  const Ray on_grid = ray({random.on_grid(9), random.on_grid(4)});
  switch (kind) {
    case ShapeKind::random: {
      const Quadric q = drawn(random, [&] { return random.symmetric(); });
      return {ray({random.in_cube(2), random.in_cube(1)}), q};
    }
    case ShapeKind::grid:
      return {on_grid, grid};
    case ShapeKind::tangent: {
      const Vec3 center = random.on_grid(5), offset = random.on_grid(4);
      const Vec3 d = glm::cross(offset, random.on_grid(3));
      const Vec3 o = center + offset + d * static_cast<float>(random.between(-4, 2));
      return {ray({o, random.jitter(d, random.between(0, 1))}),
              sphere(center, glm::dot(offset, offset))};
    }
    case ShapeKind::on_surface: {
      Quadric q = grid;
      q.j -= value(q, on_grid.o);
      return {on_grid, q};
    }
    case ShapeKind::axis_aligned: {
      Ray r = on_grid;
      r.d = Vec3(0);
      r.d[random.between(0, 2)] = random.one_in(2) ? 1.0f : -1.0f;
      return {r, grid};
    }
    case ShapeKind::full_range: {
      const int k = random.one_in(2) ? random.between(-149, 107) : -149;
      const int l = k == -149 ? 127 : k + 20;
      const Quadric q = drawn(random, [&] { return random.any_float(k, l); });
      return {ray({random.any_vector(-149, 127), random.any_vector(-149, 127)}), q};
    }
    case ShapeKind::subnormal: {
      const float s = random.power_of_two(-149, -120);
      const Quadric q = drawn(random, [&] { return small() * s; });
      return {ray({random.on_grid(9, random.power_of_two(-149, 0)), random.on_grid(3, s)}), q};
    }
    case ShapeKind::special:
      break;
  }
  const Ruled ruled = random_ruled(random);
  const float steps = static_cast<float>(random.between(-9, 2));
  const Vec3 o = ruled.on_line + steps * ruled.direction;
  const Vec3 aside = random.one_in(2) ? random.on_grid(3) : Vec3(0);
  return {ray({o + aside, ruled.direction}), ruled.quadric};
}

}  // namespace microtrace::adversarial
