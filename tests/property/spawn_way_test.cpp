// Checks the guarantees of bvh.hpp for the segment to a spawned origin in degenerate cases: rays
// within surfaces, triangles without area, and hits on vertices and edges.

#include "exact/first_hit.hpp"
#include "exact/implicit.hpp"
#include "exact/triangle_hit.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/effort.hpp"
#include "support/reproduction.hpp"

#include <microtrace/bvh.hpp>

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;
using exact::Dyadic;
using exact::Vector;

Scene touching_scene(Random& random) {
  Scene scene;
  const auto add = [&](const Shape& shape) {
    scene.objects.push_back({.name = "", .shape = shape});
  };
  for (int i = random.one_in(2) ? 12 : 40; i > 0; --i) {
    const Vec3 a = random.on_grid(3), b = random.on_grid(3), c = random.on_grid(3);
    add(Triangle{a, b, random.one_in(8) ? a + a - b : c});
  }
  for (int i = random.between(0, 3); i > 0; --i) {
    const Vec3 at = random.on_grid(3), normal = random.on_grid(1);
    switch (random.between(0, 3)) {
      case 0:
        add(Disc{.center = at, .normal = normal, .radius = 2});
        break;
      case 1:
        add(Sphere{.center = at, .radius = 2});
        break;
      case 2:
        add(Plane{.point = at, .normal = normal});
        break;
      default:
        add(Quadric{.a = 1, .b = -1, .j = float(random.between(-1, 1))});  // contains lines
        break;
    }
  }
  return scene;
}

/// A point with rational coordinates: `point` / `weight`, where weight > 0.
struct Rational {
  Vector point;
  Dyadic weight;
};

/// Returns the ray's point slightly before or behind t. Its coordinates are rational because t is.
Rational beside(const Ray& ray, const exact::Root& t, bool before) {
  const Dyadic little = before ? Dyadic(-0x1p-200) : Dyadic(0x1p-200);
  return {t.r * exact::vector(ray.o) + (t.p + little * t.r) * exact::vector(ray.d), t.r};
}

/// Returns true if the segment from w to q, excluding w, meets the triangle.
bool is_met(const Triangle& triangle, const Rational& w, const Vec3& q) {
  const Vector from = exact::vector(q), to_w = w.point - w.weight * from;
  const Vector a = exact::vector(triangle.a) - from, b = exact::vector(triangle.b) - from,
               c = exact::vector(triangle.c) - from;
  const Vector n = cross(b - a, c - a);
  const int side_of_q = (-dot(n, a)).sign(),
            side_of_w = (dot(n, to_w) - w.weight * dot(n, a)).sign();
  if (side_of_q * side_of_w > 0 || (side_of_w == 0 && side_of_q != 0)) return false;
  if (side_of_w != 0) {
    const int u = dot(to_w, cross(b, c)).sign(), v = dot(to_w, cross(c, a)).sign(),
              s = dot(to_w, cross(a, b)).sign();
    return u * v >= 0 && v * s >= 0 && s * u >= 0;
  }
  // The segment is in the triangle's plane. The two are disjoint if a line through two of the five
  // points separates them.
  const auto side = [&](const Vector& x, const Vector& y) { return dot(n, cross(x, y)).sign(); };
  const std::array<Vector, 3> corners{a, b, c};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector &x = corners[k], edge = corners[(k + 1) % 3] - x;
    if (side(edge, Dyadic(-1.0F) * x) < 0 && side(edge, to_w - w.weight * x) < 0) return false;
  }
  const int first = side(to_w, a);
  return first == 0 || side(to_w, b) != first || side(to_w, c) != first;
}

struct WayCount {
  std::size_t origins = 0, within_planes = 0, without_area = 0;
};

void check_way(const Scene& scene, PrimitiveId own, const Ray& ray, const exact::Root& t,
               const Vec3& direction, const Vec3& q, WayCount& count) {
  std::visit(
      [&]<class S>(const S& shape) {
        if constexpr (!std::is_same_v<S, Mesh>) {
          const exact::Implicit f(shape);
          const int before = f.sign_behind(ray, t, -ray.d);
          int side = f.sign_behind(ray, t, direction);
          if (side == 0) side = before;
          const Rational w = beside(ray, t, before == 0 || side == before);
          const Vec3 to_w = before == 0 || side == before ? -ray.d : ray.d;
          for (PrimitiveId id = 0; id < scene.objects.size(); ++id) {
            const Shape& other = scene.objects[id].shape;
            if (const auto* triangle = std::get_if<Triangle>(&other)) {
              if (!exact::TrianglePlane(*triangle).has_area()) {
                ++count.without_area;
                continue;
              }
              const exact::Implicit plane(*triangle);
              count.within_planes +=
                  plane.sign_at(ray, t) == 0 && plane.sign_behind(ray, t, ray.d) == 0;
              ASSERT_FALSE(is_met(*triangle, w, q))
                  << id << " after " << own << reproduction(ray, shape);
            } else if (id != own) {
              std::visit(
                  [&]<class Other>(const Other& surface) {
                    if constexpr (!std::is_same_v<Other, Mesh>) {
                      if constexpr (std::is_same_v<Other, Disc>) {
                        if (glm::distance(q, surface.center) > surface.radius - 0x1p-10F) return;
                      }
                      const exact::Implicit g(surface);
                      int expected = g.sign_at(ray, t);
                      if (expected == 0) expected = g.sign_behind(ray, t, to_w);
                      const int actual = g.value(exact::vector(q)).sign();
                      ASSERT_TRUE(expected == 0 || expected == actual) << reproduction(ray, shape);
                    }
                  },
                  other);
            }
          }
        }
      },
      scene.objects[own].shape);
  ++count.origins;
}

TEST(SpawnWay, MeetsNoTriangleWithAnAreaAndChangesNoSide) {
  Random random = traversal::announced_random(90);
  WayCount count;
  const std::size_t rays = traversal::ray_count(0.05);
  for (std::size_t done = 0; done < rays && !HasFatalFailure();) {
    const Scene scene = touching_scene(random);
    const Bvh bvh(scene);
    for (int i = 0; i < 100; ++i, ++done) {
      Ray ray{.o = random.on_grid(4), .t_min = 0, .d = random.on_grid(2)};
      if (random.one_in(3)) ray.d = random.in_cube(1);
      if (ray.d == Vec3(0)) continue;
      const auto hit = bvh.intersect(ray);
      if (!hit) continue;
      const exact::Root t = bvh.primitives().visit(
          hit->id, [&](const auto& shape) { return *exact::first_hit(shape, ray); });
      if (t.sign != 0) continue;
      const Vec3 direction = random.one_in(2) ? random.on_grid(1) : random.in_cube(1);
      const auto q = bvh.spawn_origin(ray, *hit, direction);
      if (q) check_way(scene, hit->id, ray, t, direction, *q, count);
    }
  }
  EXPECT_GT(count.origins, rays / 4);
  EXPECT_GT(count.within_planes, rays / 100);
  EXPECT_GT(count.without_area, rays / 4);
}

}  // namespace
}  // namespace microtrace
