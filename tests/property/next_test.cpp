// Compares all hits of a ray, as enumerated by Bvh::next, with all exact roots in order. ctest runs
// this for every instruction set of the machine.

#include "accel/kernels/dispatch.hpp"
#include "exact/first_hit.hpp"
#include "support/cases/adversarial_scenes.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

std::vector<Hit> by_definition(const Primitives& primitives, const Ray& ray) {
  std::vector<std::pair<exact::Root, PrimitiveId>> roots;
  primitives.for_each([&](PrimitiveId id, const auto& shape) {
    if (const auto root = exact::first_hit(shape, ray)) roots.emplace_back(*root, id);
  });
  // The roots are already sorted by id.
  std::stable_sort(roots.begin(), roots.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Hit> hits;
  for (const auto& [root, id] : roots) hits.push_back({.id = id, .t = exact::round_to_float(root)});
  return hits;
}

std::vector<Hit> one_after_another(const Bvh& bvh, const Ray& ray) {
  std::vector<Hit> hits;
  const std::size_t limit = std::size_t{bvh.primitives().count()} + 1;
  for (auto hit = bvh.intersect(ray); hit && hits.size() < limit; hit = bvh.next(ray, *hit))
    hits.push_back(*hit);
  return hits;
}

::testing::AssertionResult same(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  const auto equal = [](const Hit& x, const Hit& y) { return x.id == y.id && x.t == y.t; };
  if (std::equal(a.begin(), a.end(), b.begin(), b.end(), equal))
    return ::testing::AssertionSuccess();
  auto failure = ::testing::AssertionFailure();
  const auto show = [&](const std::vector<Hit>& hits) {
    for (const Hit& hit : hits) failure << ' ' << hit.id << " at " << hit.t << ',';
  };
  show(a);
  failure << " is not";
  show(b);
  return failure;
}

// The parameter is the instruction set.
class Next : public testing::TestWithParam<const Kernels*> {
 protected:
  void SetUp() override {
    setenv("MICROTRACE_ISA", GetParam()->name, 1);
    ASSERT_EQ(&kRayKernels.best(), GetParam());
  }
  void TearDown() override { unsetenv("MICROTRACE_ISA"); }
};

INSTANTIATE_TEST_SUITE_P(Isa, Next, testing::ValuesIn(kRayKernels.available()),
                         [](const auto& isa) { return std::string(isa.param->name); });

TEST_P(Next, EnumeratesAllHitsInExactOrder) {
  Random random(21);
  std::size_t hits = 0, ties = 0;
  for (int round = 0; round < 150; ++round) {
    const Scene scene = random_scene(random);
    const Bvh bvh(scene);
    for (int i = 0; i < 24; ++i) {
      const Ray ray = random_ray(random, scene, origin(random, scene));
      const std::vector<Hit> expected = by_definition(bvh.primitives(), ray);
      ASSERT_TRUE(same(one_after_another(bvh, ray), expected))
          << "scene " << round << ", ray " << i;
      hits += expected.size();
      for (std::size_t k = 1; k < expected.size(); ++k)
        ties += expected[k].t == expected[k - 1].t ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 10000U);
  EXPECT_GT(ties, 1000U);
}

// Casts rays through sixty coplanar copies, followed by sixty triangles at distances of one ulp.
TEST_P(Next, OrdersLayersThatFloatsCannotDistinguish) {
  Scene scene;
  const auto add = [&](float z) {
    scene.objects.push_back(
        {.name = "",
         .shape = Triangle{Vec3(-1, -1, z), Vec3(3, -1, z), Vec3(-1, 3, z + 0x1p-22F)}});
  };
  for (int i = 0; i < 60; ++i) add(1);
  for (int i = 60; i > 0; --i) add(1 + float(i) * 0x1p-23F);
  const Bvh bvh(scene);
  Random random(22);
  for (int i = 0; i < 50; ++i) {
    const Ray ray{.o = random.in_cube(0.5F), .d = {random.symmetric() / 4, 0.1F, 1}};
    const std::vector<Hit> hits = one_after_another(bvh, ray);
    ASSERT_TRUE(same(hits, by_definition(bvh.primitives(), ray))) << i;
    ASSERT_EQ(hits.size(), 120U);
  }
}

// Duplicates may start at another vertex or have the opposite winding. The scenes also contain
// triangles that are no duplicates, but are hit at the same t.
TEST_P(Next, FindsDuplicateTriangles) {
  Random random(23);
  std::size_t ties = 0;
  for (int round = 0; round < 8; ++round) {
    Scene scene = random_scene(random);
    const auto place = [&] {
      return random.between(0, static_cast<int>(scene.objects.size()) - 1);
    };
    for (int copy = 0; copy < 40; ++copy) {
      Object object = scene.objects[static_cast<std::size_t>(place())];
      if (auto* t = std::get_if<Triangle>(&object.shape)) {
        if (copy % 2 == 0) *t = {t->b, t->c, t->a};
        if (copy % 3 == 0) std::swap(t->a, t->b);
      }
      scene.objects.insert(scene.objects.begin() + place(), object);
    }
    const Bvh bvh(scene);
    for (int i = 0; i < 12; ++i) {
      const Ray ray = random_ray(random, scene, origin(random, scene));
      const std::vector<Hit> expected = by_definition(bvh.primitives(), ray);
      ASSERT_TRUE(same(one_after_another(bvh, ray), expected))
          << "scene " << round << ", ray " << i;
      for (std::size_t k = 1; k < expected.size(); ++k)
        ties += expected[k].t == expected[k - 1].t ? 1 : 0;
    }
  }
  EXPECT_GT(ties, 1000U);
}

TEST_P(Next, HasNoSuccessorOfAMiss) {
  Scene scene;
  for (int i = 0; i < 40; ++i)
    scene.objects.push_back({.name = "", .shape = Sphere{Vec3(0, 0, -3 * (i + 1)), 1}});
  const Bvh bvh(scene);
  const Ray ray{.t_max = 20};
  EXPECT_EQ(bvh.next(ray, {.id = 2})->id, 3U);
  EXPECT_EQ(bvh.next(ray, {.id = 2})->t, 11);
  EXPECT_FALSE(bvh.next(ray, {.id = 6}).has_value());   // the last within t_max
  EXPECT_FALSE(bvh.next(ray, {.id = 30}).has_value());  // beyond t_max
  EXPECT_FALSE(bvh.next(ray, {.id = 1000}).has_value());
  EXPECT_FALSE(bvh.next({.d = Vec3(0)}, {.id = 0}).has_value());
  EXPECT_FALSE(bvh.next({.o = {5, 0, 0}}, {.id = 0}).has_value());
}

}  // namespace
}  // namespace microtrace
