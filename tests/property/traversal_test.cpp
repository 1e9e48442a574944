// The tree and its kernels against every primitive asked by the float64 filters and exact
// arithmetic behind them (filter_test.cpp holds those to the exact answer). ctest runs this for
// every instruction set that the machine has.

#include "accel/bundle.hpp"
#include "accel/kernels/dispatch.hpp"
#include "support/adversarial_scenes.hpp"

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

using namespace adversarial;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::optional<Hit> by_asking_all(const Primitives& primitives, const Ray& ray) {
  if (!exact::is_valid(ray)) return std::nullopt;
  Bundle bundle(primitives, std::span(&ray, 1));
  primitives.for_each([&](PrimitiveId id, const auto& shape) { bundle.meet(id, shape); });
  return bundle.hit(0);
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
