// Compares the tree and its kernels with a test of every primitive, for each kernel that the
// machine supports, each function, and adversarial scenes and rays. MICROTRACE_TRAVERSAL_RAYS
// scales the number of rays.

#include "accel/kernels/dispatch.hpp"
#include "accel/resolve/closest_hit_finder.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "exact/first_hit.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/effort.hpp"
#include "support/hit_by_definition.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

constexpr float kRayInfinity = std::numeric_limits<float>::infinity();

using Answers = std::vector<std::optional<Hit>>;

// Returns the nearest hit computed by the float64 filters, which filter_test.cpp compares with
// exact arithmetic. Exact arithmetic decides uncertain cases.
std::optional<Hit> by_asking_all(const Primitives& primitives, const Ray& ray) {
  if (!exact::is_valid(ray)) return std::nullopt;
  const HitResolver resolver(primitives, ray);
  const ExactHits exactly(primitives, ray);
  ClosestHitFinder closest;
  for (PrimitiveId id = 0; id < primitives.count(); ++id)
    closest.consider(id, resolver.filtered(id), exactly);
  return closest.rounded(exactly);
}

bool is_without_area(const Primitives& primitives, PrimitiveId id) {
  return primitives.visit(id, []<class AnyShape>(const AnyShape& shape) {
    if constexpr (std::is_same_v<AnyShape, Triangle>) {
      const DVec3 a(shape.a);
      return glm::cross(DVec3(shape.b) - a, DVec3(shape.c) - a) == DVec3(0);
    } else {
      return false;
    }
  });
}

// Adds rays with a common origin, which form a packet. They are often nearly parallel.
void add_tile(Random& random, const Scene& scene, std::vector<Ray>& rays) {
  const Vec3 o = origin(random, scene);
  const bool coherent = random.one_in(2);
  const Ray middle = random_ray(random, scene, o);
  for (int i = random.between(1, 64); i > 0; --i) {
    rays.push_back(coherent ? middle : random_ray(random, scene, o));
    if (coherent) rays.back().d = random.jitter(middle.d, 1 << random.between(0, 20));
  }
}

// Alternates packets and incoherent rays. Sometimes there are more incoherent rays than fit into
// one batch of a stream.
std::vector<Ray> rays_for(Random& random, const Scene& scene) {
  std::vector<Ray> rays;
  for (int part = random.between(1, 6); part > 0; --part) {
    for (int tile = random.between(0, 6); tile > 0; --tile) add_tile(random, scene, rays);
    const int count = random.one_in(12) ? 2500 : random.between(1, 200);
    const std::vector<Ray> unrelated = unrelated_rays(random, scene, count);
    rays.insert(rays.end(), unrelated.begin(), unrelated.end());
  }
  return rays;
}

// Calls every function of the tree and compares the results.
void check_calls(const Bvh& bvh, const std::vector<Ray>& rays, const Answers& expected) {
  Answers together(rays.size(), Hit{});
  bvh.intersect(rays, together);
  const auto occluded = std::make_unique<bool[]>(rays.size());
  bvh.occluded(rays, std::span(occluded.get(), rays.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(same(together[i], expected[i])) << "ray " << i;
    ASSERT_EQ(occluded[i], expected[i].has_value()) << "ray " << i;
    ASSERT_TRUE(same(bvh.intersect(rays[i]), expected[i])) << "ray " << i;
    ASSERT_EQ(bvh.occluded(rays[i]), expected[i].has_value()) << "ray " << i;
  }
}

class Traversal : public testing::TestWithParam<SceneKind> {};

INSTANTIATE_TEST_SUITE_P(Scenes, Traversal, testing::ValuesIn(kSceneKinds),
                         [](const auto& kind) { return std::string(name(kind.param)); });

TEST_P(Traversal, EveryKernelAndFunctionEqualsTestingEveryPrimitive) {
  Random random = traversal::announced_random(11 + static_cast<std::uint64_t>(GetParam()));
  const std::size_t count = traversal::ray_count(double{1} / kSceneKinds.size()) + 1;
  std::size_t cast = 0, hits = 0, hits_without_area = 0;
  for (int round = 0; cast < count; ++round) {
    SCOPED_TRACE(round);
    const Scene scene = random_scene(random, GetParam());
    const std::vector<Ray> rays = rays_for(random, scene);
    const Primitives primitives(scene);
    Answers expected;
    for (const Ray& ray : rays) {
      expected.push_back(by_asking_all(primitives, ray));
      hits += expected.back().has_value() ? 1 : 0;
      if (expected.back() && is_without_area(primitives, expected.back()->id)) ++hits_without_area;
      if (random.one_in(32)) {
        ASSERT_TRUE(same(expected.back(), hit_by_definition(primitives, ray)));
      }
    }
    with_each_kernel([&] { check_calls(Bvh(scene), rays, expected); });
    if (testing::Test::HasFatalFailure()) return;
    cast += rays.size();
  }
  EXPECT_GT(hits, count / 8);
  if (GetParam() == SceneKind::degenerate) {
    EXPECT_GT(hits_without_area, count / 50);
  }
}

// Kernels scale rays with long directions. Shapes anywhere in the float32 range must still be hit.
TEST(TraversalFarAway, LongDirectionsHitDistantShapes) {
  Random random = traversal::announced_random(29);
  std::size_t hits = 0;
  for (int round = 0; round < 60; ++round) {
    const float size = random.power_of_two(30, 125);
    Scene scene;
    for (int i = 0; i < 20; ++i) {
      const Vec3 a = random.in_cube(size), b = random.in_cube(size), c = random.in_cube(size);
      scene.objects.push_back({.name = "", .shape = Triangle{a, b, c}});
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 100; ++i) {
      const float length = random.one_in(2) ? size : random.power_of_two(-126, 126);
      rays.push_back({.o = random.one_in(4) ? random.in_cube(1) : random.in_cube(0x1p-140F),
                      .t_min = 0,
                      .d = random.in_cube(length)});
      if (random.one_in(4)) rays.back().t_max = random.power_of_two(-120, 120);
    }
    const Primitives primitives(scene);
    Answers expected;
    for (const Ray& ray : rays) {
      expected.push_back(hit_by_definition(primitives, ray));
      hits += expected.back() ? 1 : 0;
    }
    with_each_kernel([&] { check_calls(Bvh(scene), rays, expected); });
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 2000U);
}

// The rays start next to a vertex and run almost in the triangle's plane. Rounding may put the
// triangle behind their origins, but they must hit it.
TEST(TraversalNextToACorner, FindsHitsOfRaysAlmostInThePlane) {
  Random random = traversal::announced_random(28);
  std::size_t hits_of_own = 0;
  for (int round = 0; round < 60; ++round) {
    Scene scene;
    for (int i = 0; i < 20; ++i) {
      const Vec3 a = random.in_cube(1), b = random.in_cube(1), c = random.in_cube(1);
      scene.objects.push_back({.name = "", .shape = Triangle{a, b, c}});
    }
    std::vector<Ray> rays;
    std::vector<PrimitiveId> owns;
    for (int i = 0; i < 64; ++i) {
      const PrimitiveId own = random.bits() % 20;
      const Triangle& t = std::get<Triangle>(scene.objects[own].shape);
      const Vec3 opposite = t.b + (t.c - t.b) * static_cast<float>(random.unit());
      const Vec3 d = (opposite - t.a) * random.power_of_two(-6, 6);
      rays.push_back({.o = random.jitter(t.a, 3), .t_min = 0, .d = random.jitter(d, 1)});
      // Adds seven rays with the same origin, so that eight form a packet.
      for (int k = 0; k < 7; ++k)
        rays.push_back({.o = rays.back().o, .t_min = 0, .d = random.jitter(d, 1)});
      owns.insert(owns.end(), 8, own);
    }
    const Primitives primitives(scene);
    Answers expected;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      expected.push_back(hit_by_definition(primitives, rays[i]));
      hits_of_own += expected.back() && expected.back()->id == owns[i] ? 1 : 0;
    }
    with_each_kernel([&] { check_calls(Bvh(scene), rays, expected); });
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(hits_of_own, 2000U);
}

TEST(TraversalOfADeepTree, StreamsEqualSingleRays) {
  Random random(14);
  Scene scene;
  scene.objects.push_back(
      {.name = "", .shape = mesh_of(30000, [&] {
                     const Vec3 c = random.in_cube(1);
                     const float size = random.power_of_two(-9, -4);
                     return Corners{c, c + random.in_cube(size), c + random.in_cube(size)};
                   })});
  std::vector<Ray> rays;
  for (int group = 0; group < 100; ++group) {
    const Vec3 center = random.in_cube(1);
    const float t_max = random.one_in(3) ? kRayInfinity : float(random.unit());
    for (int i = 0; i < 50; ++i)
      rays.push_back({.o = center + random.in_cube(0.05F), .d = random.in_cube(1), .t_max = t_max});
  }
  Answers expected;
  std::size_t found = 0;
  with_each_kernel([&] {
    const Bvh bvh(scene);
    if (expected.empty()) {
      for (const Ray& ray : rays) {
        expected.push_back(bvh.intersect(ray));
        found += expected.back().has_value() ? 1 : 0;
      }
    }
    check_calls(bvh, rays, expected);
  });
  EXPECT_GT(found, rays.size() / 8);
  EXPECT_LT(found, rays.size());
}

// Each ray of a packet meets several triangles that the tree does not sort by distance. Their
// number exceeds that of the triangles that a packet keeps.
TEST(TraversalOfManyLayers, PacketsEqualTestingEveryPrimitive) {
  constexpr int kLayers = 12;
  Random random(47);
  Scene scene;
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i) {
    const Vec3 d(static_cast<float>(i % 8) - 3.5F, static_cast<float>(i / 8) - 3.5F, 16);
    rays.push_back({.o = Vec3(0), .d = d});
    for (int layer = 0; layer < kLayers; ++layer) {
      const Vec3 middle = d * (1 + 0.001F * static_cast<float>(random.unit()));
      const Triangle triangle{middle + Vec3(-0.2F, -0.2F, 0), middle + Vec3(0.3F, -0.2F, 0),
                              middle + Vec3(-0.2F, 0.3F, 0)};
      scene.objects.push_back({.name = "", .shape = triangle});
    }
  }
  const Primitives primitives(scene);
  Answers expected;
  for (const Ray& ray : rays) expected.push_back(by_asking_all(primitives, ray));
  with_each_kernel([&] { check_calls(Bvh(scene), rays, expected); });
}

}  // namespace
}  // namespace microtrace
