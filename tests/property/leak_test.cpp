// Checks that no ray leaves a closed mesh from inside, not even through a vertex or along an edge.

#include "accel/kernels/dispatch.hpp"
#include "exact/implicit.hpp"
#include "support/cases/closed_meshes.hpp"
#include "support/effort.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

class Leak : public testing::TestWithParam<std::size_t> {
 protected:
  void TearDown() override { unsetenv("MICROTRACE_ISA"); }
};

INSTANTIATE_TEST_SUITE_P(Meshes, Leak, testing::Range<std::size_t>(0, 5),
                         [](const auto& i) { return std::string(closed_meshes()[i.param].name); });

// Uses a fifth of all rays for each mesh. Casts each ray alone, in a packet and in a stream, with
// alternating kernels.
TEST_P(Leak, NoRayFromWithinLeavesThroughCornersOrEdges) {
  const ClosedMesh closed = closed_meshes()[GetParam()];
  Scene scene;
  scene.objects.push_back({.name = "", .shape = closed.mesh});
  std::vector<Bvh> trees;
  for (const Kernels* kernels : kRayKernels.available()) {
    setenv("MICROTRACE_ISA", kernels->name, 1);
    trees.emplace_back(scene);
  }
  Random random = traversal::announced_random(30 + GetParam());
  constexpr std::size_t kTile = 64, kBatch = 32 * kTile;
  const auto steps = static_cast<int>(closed.radius / 2 / closed.spacing);
  std::vector<Ray> rays(kBatch), apart(kBatch);
  std::vector<std::optional<Hit>> hits(kBatch);
  const auto occluded = std::make_unique<bool[]>(kBatch);
  const auto check_hits = [&] {
    for (const auto& hit : hits) {
      ASSERT_TRUE(hit.has_value());
      ASSERT_LE(hit->t, 1);
    }
  };
  std::size_t turn = 0;
  const auto next_tree = [&]() -> const Bvh& { return trees[turn++ % trees.size()]; };
  const std::size_t batches = traversal::ray_count(0.2) / kBatch + 1;
  for (std::size_t batch = 0; batch < batches && !HasFatalFailure(); ++batch) {
    Vec3 o{0};
    for (std::size_t i = 0; i < kBatch; ++i) {
      if (i % kTile == 0) o = closed.center + random.on_grid(steps, closed.spacing);
      rays[i] = aimed_exactly(random, closed, o);
    }
    const Bvh& singly = next_tree();
    for (std::size_t i = 0; i < kBatch; ++i) hits[i] = singly.intersect(rays[i]);
    check_hits();
    next_tree().intersect(rays, hits);
    check_hits();
    for (std::size_t i = 0; i < kBatch; ++i) apart[i] = rays[i % 32 * kTile + i / 32];
    const Bvh& stream = next_tree();
    stream.intersect(apart, hits);
    check_hits();
    if (batch % 4 == 0) {
      stream.occluded(apart, std::span(occluded.get(), kBatch));
      ASSERT_TRUE(std::all_of(occluded.get(), occluded.get() + kBatch, [](bool b) { return b; }));
    }
    ++turn;  // shifts the assignment of kernels, so that each function uses each kernel
  }
}

std::size_t count_hits(const Bvh& bvh, const Ray& ray) {
  std::size_t count = 0;
  for (auto hit = bvh.intersect(ray); hit; hit = bvh.next(ray, *hit)) ++count;
  return count;
}

// Follows paths of many reflections. Each starts at a vertex, on an edge, or next to one. Spawned
// origins must be inside again.
TEST_P(Leak, NoPathFromWithinLeaves) {
  const ClosedMesh closed = closed_meshes()[GetParam()];
  Scene scene;
  scene.objects.push_back({.name = "", .shape = closed.mesh});
  const Bvh bvh(scene);
  Random random = traversal::announced_random(40 + GetParam());
  const auto steps = static_cast<int>(closed.radius / 2 / closed.spacing);
  const std::size_t paths = traversal::ray_count(0.005);
  std::size_t bounces = 0, ends = 0;
  for (std::size_t path = 0; path < paths; ++path) {
    const Vec3 o = closed.center + random.on_grid(steps, closed.spacing);
    Ray ray = aimed_exactly(random, closed, o);
    if (random.one_in(2)) ray.d = random.jitter(ray.d, 4);
    for (int bounce = 0; bounce < 6; ++bounce) {
      const auto hit = bvh.intersect(ray);
      ASSERT_TRUE(hit.has_value()) << "path " << path << ", bounce " << bounce;
      const exact::Implicit face(triangle_of(closed.mesh, hit->id));
      const exact::Root t = exact::rational(0.0F);  // any t gives the same slope of a plane
      // Reflects to the side of the incoming ray. The direction is sometimes along a neighboring
      // edge or the face.
      Vec3 d = random.in_cube(1);
      if (random.one_in(3)) d = aimed_exactly(random, closed, o).d;
      const int side = face.sign_behind(ray, t, -ray.d), there = face.sign_behind(ray, t, d);
      if (side * there < 0) d = -d;
      if (d == Vec3(0)) break;
      const auto q = bvh.spawn_origin(ray, *hit, d);
      // Batches are computed by another algorithm, which must find the same origins.
      const std::array<Bvh::Spawn, 3> spawns{{{.ray = &ray, .hit = *hit, .direction = d},
                                              {.ray = &ray, .hit = *hit, .direction = -d},
                                              {.ray = &ray, .hit = *hit, .direction = ray.d}}};
      std::array<std::optional<Vec3>, 3> origins;
      bvh.spawn_origins(spawns, origins);
      for (std::size_t i = 0; i < 3; ++i)
        ASSERT_EQ(origins[i], bvh.spawn_origin(ray, *hit, spawns[i].direction)) << path;
      if (!q) {
        ++ends;
        break;
      }
      for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(bvh.occluded({.o = *q, .t_min = 0, .d = random.in_cube(1)}))
            << "path " << path << ", bounce " << bounce;
      }
      // Also transmits through the face. From outside, a ray that hits no edge must cross an even
      // number of faces.
      if (bounce > 0 && side * there != 0) {
        const auto outside = bvh.spawn_origin(ray, *hit, -d);
        ASSERT_TRUE(outside.has_value());
        ASSERT_EQ(count_hits(bvh, {.o = *outside, .t_min = 0, .d = random.in_cube(1)}) % 2, 0U)
            << "path " << path << ", bounce " << bounce;
      }
      ray = {.o = *q, .t_min = 0, .d = d};
      ++bounces;
    }
  }
  EXPECT_GT(bounces, paths * 5);
  EXPECT_LT(ends, paths / 100);
}

}  // namespace
}  // namespace microtrace
