// Checks the guarantees of spawn.hpp with exact arithmetic: the origin's side of the surface, no
// repeated hit of the same surface, and the distance to the hit point.

#include "accel/kernels/dispatch.hpp"
#include "exact/first_hit.hpp"
#include "exact/implicit.hpp"
#include "exact/range.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/effort.hpp"
#include "support/reproduction.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/spawn.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

// Sanitized builds test fewer cases.
const int kSpawnCases = static_cast<int>(traversal::kUsualRays / 50);
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class S>
constexpr bool is_flat =
    std::is_same_v<S, Triangle> || std::is_same_v<S, Plane> || std::is_same_v<S, Disc>;

// Returns any direction, including grazing ones, tangents, and directions into the surface.
Vec3 any_direction(Random& random, const Ray& ray, const Vec3& towards) {
  switch (random.between(0, 6)) {
    case 0:
      return -ray.d;
    case 1:
      return ray.d;
    case 2:
      return random.jitter(towards, 3);  // nearly parallel to the surface
    case 3:
      return random.on_grid(2);
    case 4:
      return random.in_cube(1) * random.power_of_two(-60, 60);
    case 5: {
      Vec3 d{0};
      d[random.between(0, 2)] = random.one_in(2) ? 1.0F : -1.0F;
      return d;
    }
    default:
      return random.in_cube(1);
  }
}

Vec3 within(const Triangle& t) {
  return t.b - t.a;
}
Vec3 within(const Plane& p) {
  return {p.normal.y, -p.normal.x, 0};
}
Vec3 within(const Disc& d) {
  return {-d.normal.z, 0, d.normal.x};
}
Vec3 within(const Sphere& s) {
  return {s.radius, s.center.x, 1};
}
Vec3 within(const Quadric& q) {
  return {q.a, q.h, q.c};
}

// Returns the number of float32 numbers between a and b.
std::int64_t steps(float a, float b) {
  const auto place = [](float x) {
    const std::int64_t bits = std::bit_cast<std::int32_t>(std::abs(x));
    return x < 0 ? -bits : bits;
  };
  return std::abs(place(a) - place(b));
}

template <class S>
void check_nearness(const S& shape, const Ray& ray, const Vec3& q, const Vec3& direction) {
  const Vec3 p = exact::round_point(ray, *exact::first_hit(shape, ray));
  int moved_axes = 0;
  std::int64_t most = 0;
  for (int k = 0; k < 3; ++k) {
    moved_axes += p[k] != q[k] ? 1 : 0;
    most = std::max(most, steps(p[k], q[k]));
  }
  ASSERT_LE(moved_axes, 1) << reproduction(ray, shape);
  ASSERT_LE(most, is_flat<S> ? 4 : 64) << reproduction(ray, shape) << direction.x;
}

struct SpawnCount {
  int hits = 0, spawned = 0;
};

template <class S>
void check(Random& random, const Ray& ray, const S& shape, SpawnCount& count) {
  const auto t = exact::first_hit(shape, ray);
  const Vec3 direction = any_direction(random, ray, within(shape));
  const auto q = spawn_origin(shape, ray, direction);
  if (!t) {
    ASSERT_FALSE(q.has_value()) << reproduction(ray, shape);
    return;
  }
  if (direction == Vec3(0) || !is_finite(direction)) {
    ASSERT_FALSE(q.has_value());
    return;
  }
  ++count.hits;
  if (!q) return;
  ++count.spawned;
  const exact::Implicit f(shape);
  // At the exact hit point, the outgoing ray determines the side. If it is tangent, the incoming
  // ray does.
  int side = f.sign_behind(ray, *t, direction);
  if (side == 0) side = f.sign_behind(ray, *t, -ray.d);
  if (side == 0) side = 1;
  ASSERT_EQ(f.value(exact::vector(*q)).sign(), side) << reproduction(ray, shape);
  const Ray spawned{.o = *q, .t_min = 0, .d = direction};
  const bool returns = !is_flat<S> && f.quadratic(exact::vector(direction)).sign() * side < 0;
  ASSERT_EQ(exact::first_hit(shape, spawned).has_value(), returns) << reproduction(spawned, shape);
  ASSERT_EQ(f.zeros_ahead(*q, direction), returns ? 1 : 0) << reproduction(spawned, shape);
  check_nearness(shape, ray, *q, direction);
}

template <class MakeCase>
SpawnCount check_spawn_kind(std::uint64_t seed, MakeCase make_case) {
  Random random(seed);
  SpawnCount count;
  for (int i = 0; i < kSpawnCases && !testing::Test::HasFatalFailure(); ++i) {
    const auto [ray, shape] = make_case(random);
    check(random, ray, shape, count);
  }
  return count;
}

bool has_area(const Triangle& t) {
  const auto n = exact::cross(exact::vector(t.b) - exact::vector(t.a),
                              exact::vector(t.c) - exact::vector(t.a));
  return exact::nonzero_component(n) >= 0;
}

TEST(Spawn, Triangle) {
  for (const TriangleKind kind : kTriangleKinds) {
    SCOPED_TRACE(name(kind));
    const SpawnCount count =
        check_spawn_kind(31, [&](Random& random) { return triangle_case(random, kind); });
    EXPECT_GT(count.hits, kSpawnCases / 200);
  }
}

// Rays must leave every flat surface that has an area, however far away, thin or large, except at
// the ends of the float32 range.
TEST(Spawn, RaysLeaveEveryTriangleWithArea) {
  Random random(32);
  for (int i = 0; i < 5 * kSpawnCases; ++i) {
    const auto [ray, triangle] =
        triangle_case(random, kTriangleKinds[static_cast<std::size_t>(i) % kTriangleKinds.size()]);
    if (!exact::first_hit(triangle, ray) || !has_area(triangle)) continue;
    const auto q = spawn_origin(triangle, ray, random.in_cube(1));
    ASSERT_TRUE(q.has_value()) << reproduction(ray, triangle);
  }
}

// Expects an origin for every flat surface unless the hit point exceeds the largest float32.
// Expects one for every curved surface unless the surface is about as small as the spacing of
// float32 numbers.
template <class MakeCase>
void check_all_kinds(double least_share, MakeCase make_case) {
  for (const ShapeKind kind : kShapeKinds) {
    SCOPED_TRACE(name(kind));
    const SpawnCount count =
        check_spawn_kind(33, [&](Random& random) { return make_case(random, kind); });
    EXPECT_GE(count.spawned, count.hits * (kind == ShapeKind::full_range ? 0.8 : least_share));
    // Rays hit about one in 25 discs whose numbers span the full float32 range. The number varies
    // randomly.
    EXPECT_GT(count.hits, kSpawnCases / 40);
  }
}

TEST(Spawn, Plane) {
  check_all_kinds(1, plane_case);
}
TEST(Spawn, Disc) {
  check_all_kinds(1, disc_case);
}
TEST(Spawn, Sphere) {
  check_all_kinds(1, sphere_case);
}
TEST(Spawn, Quadric) {
  check_all_kinds(0.8, quadric_case);
}

// A ray that leaves a convex body must hit none of the body's faces, edges or vertices.
TEST(Spawn, RaysLeaveConvexBodies) {
  Random random(34);
  int leaves = 0;
  for (int round = 0; round < kSpawnCases; ++round) {
    // Tetrahedra are always convex.
    const float size = random.power_of_two(-30, 30);
    const Vec3 center = random.in_cube(1) * (size * random.power_of_two(0, 22));
    std::array<Vec3, 4> p;
    for (Vec3& corner : p) corner = center + random.in_cube(size);
    Scene scene;
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
      scene.objects.push_back(
          {.name = "",
           .shape = Triangle{p[static_cast<std::size_t>(a)], p[static_cast<std::size_t>(b)],
                             p[static_cast<std::size_t>(c)]}});
    const Bvh bvh(scene);
    for (int i = 0; i < 4; ++i) {
      const Vec3 o = center + random.in_cube(3 * size);
      const Vec3 target = random.one_in(2) ? p[0] : p[1] + (p[2] - p[1]) * 0.5F;
      const Ray ray{.o = o,
                    .d = random.one_in(2) ? target - o : random.jitter(target - o, 1 << 18)};
      const auto hit = bvh.intersect(ray);
      if (!hit) continue;
      const Vec3 direction = random.in_cube(1);
      const Triangle& face = std::get<Triangle>(scene.objects[hit->id].shape);
      const exact::Implicit f(face);
      const exact::Root t = *exact::first_hit(face, ray);
      const exact::Vector fourth = exact::vector(p[std::array{3U, 2U, 0U, 1U}[hit->id]]);
      const int outside = -f.value(fourth).sign();
      if (outside == 0 || f.sign_behind(ray, t, direction) != outside) continue;
      const auto q = spawn_origin(bvh.primitives(), hit->id, ray, direction);
      ASSERT_TRUE(q.has_value());
      ASSERT_FALSE(bvh.occluded({.o = *q, .t_min = 0, .d = direction})) << round;
      ++leaves;
    }
  }
  EXPECT_GT(leaves, kSpawnCases / 2);
}

// The batch algorithm must find the same origins as the single one: for shapes of all kinds, even
// touching ones, with and without a tree.
TEST(Spawn, BatchesEqualSingleOrigins) {
  Random random = traversal::announced_random(77);
  std::size_t answers = 0;
  for (int round = 0; round < 40; ++round) {
    Scene scene;
    const int count = round % 2 == 0 ? 10 : 60;
    for (int i = 0; i < count; ++i) {
      const Vec3 at = random.on_grid(3);
      Shape shape = Sphere{.center = at, .radius = random.one_in(2) ? 1.0F : 0.7F};
      if (i % 5 == 1) shape = Triangle{at, at + random.on_grid(2), at + random.in_cube(1)};
      if (i % 5 == 2) shape = Disc{.center = at, .normal = random.on_grid(1), .radius = 1};
      if (i % 10 == 3) shape = Plane{.point = at, .normal = {0, 1, 0}};
      if (i % 10 == 8) shape = Quadric{.a = 1, .b = 1, .c = 2, .h = random.in_cube(1).x, .j = -4};
      scene.objects.push_back({.name = "", .shape = shape});
    }
    const Bvh bvh(scene);
    std::vector<Ray> rays(200);
    std::vector<std::optional<Hit>> hits(rays.size());
    for (Ray& ray : rays) {
      ray = {.o = random.in_cube(5), .d = random.in_cube(1)};
      if (random.one_in(4)) ray = {.o = random.on_grid(5), .d = random.on_grid(2)};
    }
    bvh.intersect(rays, hits);
    std::vector<Bvh::Spawn> spawns;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      for (int k = 0; hits[i] && k < 3; ++k) {
        const Vec3 d = k == 0 ? -rays[i].d : k == 1 ? random.in_cube(1) : random.on_grid(1);
        spawns.push_back({.ray = &rays[i], .hit = *hits[i], .direction = d});
      }
    }
    std::vector<std::optional<Vec3>> expected;
    for (const Bvh::Spawn& spawn : spawns) {
      expected.push_back(bvh.spawn_origin(*spawn.ray, spawn.hit, spawn.direction));
      answers += expected.back() ? 1 : 0;
    }
    for (const Kernels* kernels : kRayKernels.available()) {
      setenv("MICROTRACE_ISA", kernels->name, 1);
      std::vector<std::optional<Vec3>> origins(spawns.size());
      Bvh(scene).spawn_origins(spawns, origins);
      ASSERT_EQ(origins, expected) << round << kernels->name;
    }
    unsetenv("MICROTRACE_ISA");
  }
  EXPECT_GT(answers, 5000U);
}

}  // namespace
}  // namespace microtrace
