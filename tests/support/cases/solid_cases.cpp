#include "support/cases/solid_cases.hpp"

#include "support/cases/closed_bodies.hpp"

#include <microtrace/primitives.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>

namespace microtrace::adversarial {
namespace {

struct PlaceOfBody {
  Vec3 center;
  float size;
};
const std::array<PlaceOfBody, 8> kPlaces{{{Vec3(0), 1},
                                          {Vec3(0), 0x1p-44F},
                                          {Vec3(0), 0x1p-130F},
                                          {{1, 2, 3}, 0x1p-44F},
                                          {{1000, -2000, 3000}, 1},
                                          {{0x1p20F, 0x1p21F, 0}, 100},
                                          {Vec3(0), 0x1p50F},
                                          {Vec3(0), 0x1p110F}}};

void append(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : other.positions) mesh.positions.push_back(p);
  for (const auto& [a, b, c] : other.triangles)
    mesh.triangles.push_back({a + first, b + first, c + first});
}

Mesh cube(const Vec3& lo, const Vec3& edge) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1, i >> 1 & 1, i >> 2 & 1);
    mesh.positions.push_back(lo + edge * corner);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {.positions = {a, b, c, d}, .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

Vec3 moved_by_ulps(Random& random, Vec3 p, int most) {
  for (int k = 0; k < 3; ++k) {
    for (int step = random.between(-most, most); step != 0; step += step < 0 ? 1 : -1) {
      const float infinity = std::numeric_limits<float>::infinity();
      p[k] = std::nextafter(p[k], step < 0 ? -infinity : infinity);
    }
  }
  return p;
}

}  // namespace

std::vector<SolidCase> solid_cases(Random& random, int rounds) {
  std::vector<SolidCase> cases;
  for (int round = 0; round < rounds; ++round) {
    for (const auto& [center, size] : kPlaces) {
      for (const BodyKind kind : kBodyKinds) {
        std::ostringstream name;
        name << adversarial::name(kind) << " of size " << size << ", round " << round;
        Mesh mesh = closed_body(random, kind, center, size);
        if (random.one_in(3)) append(mesh, closed_body(random, kind, center, 0.5F * size));
        cases.push_back({.name = name.str(), .mesh = mesh, .center = center, .size = size});
      }
    }
  }
  Mesh nested;
  for (int i = 5; i > 0; --i)
    append(nested, cube(Vec3(static_cast<float>(-i)), Vec3(2.0F * static_cast<float>(i))));
  cases.push_back({.name = "nested cubes", .mesh = nested, .center = Vec3(0), .size = 5});
  Mesh touching;
  for (int i = 0; i < 8; ++i) append(touching, cube(Vec3(i & 1, i >> 1 & 1, i >> 2 & 1), Vec3(1)));
  cases.push_back({.name = "touching cubes", .mesh = touching, .center = Vec3(1), .size = 1});
  cases.push_back(
      {.name = "sliver",
       .mesh = tetrahedron({0, 0, 0}, {1000, 1, 0}, {2000, 2 + 0x1p-20F, 0}, {1000, 1, 0x1p-20F}),
       .center = {1000, 1, 0},
       .size = 1000});
  cases.push_back({.name = "plate of the least number",
                   .mesh = cube(Vec3(0), {1, 1, std::numeric_limits<float>::denorm_min()}),
                   .center = Vec3(0),
                   .size = 1});
  cases.push_back({.name = "tetrahedron",
                   .mesh = tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}),
                   .center = Vec3(0.5F),
                   .size = 0.5F});
  return cases;
}

Vec3 point_about(Random& random, const SolidCase& solid_case) {
  const Mesh& mesh = solid_case.mesh;
  const auto last = static_cast<int>(mesh.triangles.size()) - 1;
  const Triangle t = triangle_of(mesh, static_cast<std::size_t>(random.between(0, last)));
  const float s = static_cast<float>(random.between(0, 8)) / 8;
  const float r = static_cast<float>(random.between(0, 8)) / 8;
  const Vec3 on_face = t.a + s * (t.b - t.a) + r * (1 - s) * (t.c - t.a);
  switch (random.between(0, 7)) {
    case 0:
      return t.a;
    case 1:
      return moved_by_ulps(random, t.b, 1);
    case 2:
      return t.a + s * (t.b - t.a);
    case 3:
      return moved_by_ulps(random, t.b + s * (t.c - t.b), 1);
    case 4:
      return on_face;
    case 5:
      return moved_by_ulps(random, on_face, 3);
    case 6:
      return on_face + random.in_cube(0x1p-10F * solid_case.size);
    default:
      return solid_case.center + random.in_cube(1.5F * solid_case.size);
  }
}

}  // namespace microtrace::adversarial
