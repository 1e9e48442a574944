// The tree and its kernels against every primitive asked by the float64 filters and exact
// arithmetic behind them (filter_test.cpp holds those to the exact answer). ctest runs this for
// every instruction set that the machine has.

#include "accel/bundle.hpp"
#include "accel/kernels/dispatch.hpp"
#include "support/adversarial_rays.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::optional<Hit> by_asking_all(const Primitives& primitives, const Ray& ray) {
  if (!exact::is_valid(ray)) return std::nullopt;
  Bundle bundle(primitives, std::span(&ray, 1));
  primitives.for_each([&](PrimitiveId id, const auto& shape) { bundle.meet(id, shape); });
  return bundle.hit(0);
}

Mesh mesh_of(int triangles, auto&& make_corner) {
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& corner : make_corner()) mesh.positions.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

using Corners = std::array<Vec3, 3>;

Mesh random_mesh(Random& random) {
  const auto near = [&](const Vec3& c, float size) { return c + random.in_cube(size); };
  switch (random.between(0, 6)) {
    case 0: {  // a soup of small triangles
      return mesh_of(random.between(1, 400), [&] {
        const Vec3 c = random.in_cube(1);
        return Corners{near(c, 0.1F), near(c, 0.1F), near(c, 0.1F)};
      });
    }
    case 1:  // an integer lattice: shared corners, coplanar walls, duplicates, no area
      return mesh_of(random.between(1, 400), [&] {
        return Corners{random.on_grid(4), random.on_grid(4), random.on_grid(4)};
      });
    case 2:  // huge and tiny
      return mesh_of(random.between(1, 300), [&] {
        const Vec3 c = random.in_cube(1);
        const float size = random.power_of_two(-20, 6);
        return Corners{near(c, size), near(c, size), near(c, size)};
      });
    case 3: {  // far from the origin
      const Vec3 c = random.in_cube(0x1p22F);
      return mesh_of(random.between(1, 300), [&] {
        return Corners{near(c, 4), near(c, 4), near(c, 4)};
      });
    }
    case 4:  // slivers
      return mesh_of(random.between(1, 300), [&] {
        const Vec3 a = random.in_cube(1), b = random.in_cube(1);
        return Corners{a, b, near((a + b) * 0.5F, random.power_of_two(-26, -6))};
      });
    case 5:  // walls through integer planes, split at whole numbers: rays along edges and within
             // planes
      return mesh_of(random.between(1, 300), [&] {
        const int axis = random.between(0, 2);
        Corners corners{random.on_grid(3), random.on_grid(3), random.on_grid(3)};
        corners[1][axis] = corners[2][axis] = corners[0][axis];
        return corners;
      });
    default:  // beyond what the kernels take, not finite
      return mesh_of(random.between(1, 100), [&] {
        const float size = random.power_of_two(-140, 60);
        Corners corners{random.in_cube(size), random.in_cube(size), random.in_cube(size)};
        if (random.one_in(10)) corners[0].x = random.one_in(2) ? NAN : kInfinity;
        return corners;
      });
  }
}

Scene random_scene(Random& random) {
  Scene scene;
  const auto add = [&](Shape shape) {
    scene.objects.push_back({.name = "", .shape = std::move(shape)});
  };
  add(random_mesh(random));
  if (random.one_in(2)) add(random_mesh(random));
  if (random.one_in(4)) add(scene.objects[0].shape);  // every hit of it is a tie
  for (int i = random.between(-20, 20); i > 0; --i) {
    add(Sphere{random.on_grid(4), float(random.between(0, 2))});
    add(Disc{random.on_grid(4), random.on_grid(2), float(random.between(0, 2))});
  }
  if (random.one_in(4)) add(Plane{random.on_grid(4), random.on_grid(2)});
  return scene;
}

// A corner, or a point of an edge or of the inside, of some triangle.
Vec3 target(Random& random, const Scene& scene) {
  const Object& object = scene.objects[static_cast<std::size_t>(
      random.between(0, static_cast<int>(scene.objects.size()) - 1))];
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  if (mesh == nullptr) return random.on_grid(4);
  const int last = static_cast<int>(mesh->triangles.size()) - 1;
  const Triangle t = triangle_of(*mesh, static_cast<std::size_t>(random.between(0, last)));
  switch (random.between(0, 3)) {
    case 0:
      return t.a;
    case 1:
      return (t.a + t.b) * 0.5F;
    case 2: {
      const float s = float(random.unit());
      return t.b + (t.c - t.b) * s;
    }
    default: {
      const float u = float(random.unit()), v = float(random.unit()) * (1 - u);
      return t.a + (t.b - t.a) * u + (t.c - t.a) * v;
    }
  }
}

Vec3 origin(Random& random, const Scene& scene) {
  switch (random.between(0, 4)) {
    case 0:
      return target(random, scene);
    case 1:
      return random.on_grid(8);
    case 2:
      return target(random, scene) + random.in_cube(3);
    case 3:
      return random.in_cube(100);
    default:
      return random.in_cube(2);
  }
}

Ray random_ray(Random& random, const Scene& scene, const Vec3& o) {
  Ray ray{.o = o, .d = target(random, scene) - o};
  if (random.one_in(6)) ray.d = random.on_grid(2);
  if (random.one_in(6)) ray.d[random.between(0, 2)] = 0;
  if (random.one_in(8)) ray.d *= random.power_of_two(-30, 30);
  if (random.one_in(20)) ray.d[random.between(0, 2)] = random.any_float(-149, -100);
  if (random.one_in(3)) ray.t_min = 0;
  if (random.one_in(5)) ray.t_max = random.one_in(2) ? 1 : float(random.unit() * 4);
  if (random.one_in(20)) ray.t_min = std::min(1.0F, ray.t_max);
  return ray;
}

::testing::AssertionResult same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  if (a.has_value() == b.has_value() && (!a || (a->id == b->id && a->t == b->t)))
    return ::testing::AssertionSuccess();
  const auto show = [](const std::optional<Hit>& hit) {
    return hit ? std::to_string(hit->id) + " at " + std::to_string(hit->t) : std::string("none");
  };
  return ::testing::AssertionFailure() << show(a) << " is not " << show(b);
}

int scale() {
  const char* text = std::getenv("MICROTRACE_TRAVERSAL_SCENES");
  return text != nullptr ? std::atoi(text) : 400;
}

constexpr int kRaysPerScene = 256;

// The instruction set is the parameter.
class Traversal : public testing::TestWithParam<const Kernels*> {
 protected:
  void SetUp() override {
    setenv("MICROTRACE_ISA", GetParam()->name, 1);
    ASSERT_EQ(&best_kernels(), GetParam());
  }
  void TearDown() override { unsetenv("MICROTRACE_ISA"); }
};

INSTANTIATE_TEST_SUITE_P(Isa, Traversal, testing::ValuesIn(available_kernels()),
                         [](const auto& isa) { return std::string(isa.param->name); });

TEST_P(Traversal, SingleRaysEqualAskingEveryPrimitive) {
  Random random(11);
  int hits = 0;
  for (int round = 0; round < scale(); ++round) {
    const Scene scene = random_scene(random);
    const Bvh bvh(scene);
    for (int i = 0; i < kRaysPerScene; ++i) {
      const Ray ray = random_ray(random, scene, origin(random, scene));
      const auto expected = by_asking_all(bvh.primitives(), ray);
      ASSERT_TRUE(same(bvh.intersect(ray), expected)) << "scene " << round << ", ray " << i;
      ASSERT_EQ(bvh.occluded(ray), expected.has_value()) << "scene " << round << ", ray " << i;
      hits += expected.has_value() ? 1 : 0;
    }
  }
  EXPECT_GT(hits, scale() * kRaysPerScene / 4);
}

TEST_P(Traversal, TilesEqualAskingEveryPrimitive) {
  Random random(12);
  for (int round = 0; round < scale(); ++round) {
    const Scene scene = random_scene(random);
    const Bvh bvh(scene);
    std::vector<Ray> rays;
    for (int tile = 0; tile < kRaysPerScene / 64; ++tile) {
      const Vec3 o = origin(random, scene);
      const bool coherent = random.one_in(2);
      const Ray middle = random_ray(random, scene, o);
      for (int i = random.between(1, 64); i > 0; --i) {
        rays.push_back(coherent ? middle : random_ray(random, scene, o));
        if (coherent) rays.back().d = random.jitter(middle.d, 1 << random.between(0, 20));
      }
    }
    std::vector<std::optional<Hit>> hits(rays.size(), Hit{});
    bvh.intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i)
      ASSERT_TRUE(same(hits[i], by_asking_all(bvh.primitives(), rays[i])))
          << "scene " << round << ", ray " << i;
  }
}

// Arrays of rays without a common origin; among them some that are not valid, too large for the
// kernels, or share an origin with their neighbours.
std::vector<Ray> unrelated_rays(Random& random, const Scene& scene, int count) {
  std::vector<Ray> rays;
  const bool near_each_other = random.one_in(3);
  const Vec3 centre = origin(random, scene);
  const float t_max = random.one_in(2) ? kInfinity : float(random.unit() * 2);
  while (static_cast<int>(rays.size()) < count) {
    const Vec3 o = near_each_other ? centre + random.in_cube(0.1F) : origin(random, scene);
    Ray ray = random_ray(random, scene, o);
    if (near_each_other) ray.t_max = std::max(ray.t_min, t_max);
    if (random.one_in(60)) ray.d *= 0x1p60F;
    if (random.one_in(60)) ray.d = Vec3(0);
    if (random.one_in(60)) ray.o[random.between(0, 2)] = random.one_in(2) ? NAN : kInfinity;
    if (random.one_in(60)) ray.t_min = -1;
    rays.insert(rays.end(), static_cast<std::size_t>(random.one_in(40) ? 12 : 1), ray);
  }
  return rays;
}

TEST_P(Traversal, StreamsEqualAskingEveryPrimitive) {
  Random random(13);
  int hits_of_all = 0;
  for (int round = 0; round < scale(); ++round) {
    const Scene scene = random_scene(random);
    const Bvh bvh(scene);
    // Sometimes more than one batch of the stream.
    const int count = random.one_in(20) ? 2500 : random.between(1, 200);
    const std::vector<Ray> rays = unrelated_rays(random, scene, count);
    std::vector<std::optional<Hit>> hits(rays.size(), Hit{});
    bvh.intersect(rays, hits);
    const auto occluded = std::make_unique<bool[]>(rays.size());
    bvh.occluded(rays, std::span(occluded.get(), rays.size()));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto expected = by_asking_all(bvh.primitives(), rays[i]);
      ASSERT_TRUE(same(hits[i], expected)) << "scene " << round << ", ray " << i;
      ASSERT_EQ(occluded[i], expected.has_value()) << "scene " << round << ", ray " << i;
      hits_of_all += expected.has_value() ? 1 : 0;
    }
  }
  EXPECT_GT(hits_of_all, scale() * 25);
}

// Thirty thousand small triangles: walks go deep, packets break up, all places of the stream fill.
TEST_P(Traversal, StreamsEqualSingleRaysInADeepTree) {
  Random random(14);
  Scene scene;
  scene.objects.push_back(
      {.name = "", .shape = mesh_of(30000, [&] {
                     const Vec3 c = random.in_cube(1);
                     const float size = random.power_of_two(-9, -4);
                     return Corners{c, c + random.in_cube(size), c + random.in_cube(size)};
                   })});
  const Bvh bvh(scene);
  std::vector<Ray> rays;
  for (int group = 0; group < 100; ++group) {
    const Vec3 centre = random.in_cube(1);
    const float t_max = random.one_in(3) ? kInfinity : float(random.unit());
    for (int i = 0; i < 50; ++i)
      rays.push_back({.o = centre + random.in_cube(0.05F), .d = random.in_cube(1), .t_max = t_max});
  }
  std::vector<std::optional<Hit>> hits(rays.size());
  bvh.intersect(rays, hits);
  const auto occluded = std::make_unique<bool[]>(rays.size());
  bvh.occluded(rays, std::span(occluded.get(), rays.size()));
  std::size_t found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(same(hits[i], bvh.intersect(rays[i]))) << "ray " << i;
    ASSERT_EQ(occluded[i], hits[i].has_value()) << "ray " << i;
    found += hits[i].has_value() ? 1 : 0;
  }
  EXPECT_GT(found, rays.size() / 8);
  EXPECT_LT(found, rays.size());
}

}  // namespace
}  // namespace microtrace
