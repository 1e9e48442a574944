// Checks that triangles without area and duplicate triangles cost almost no time. Counts the
// queries that reach exact arithmetic. ctest runs this for every instruction set of the machine.

#include "accel/kernels/dispatch.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/cases/generated_meshes.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/stage_counts.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

// The parameter is the instruction set.
class DegenerateCost : public testing::TestWithParam<const Kernels*> {
 protected:
  void SetUp() override { setenv("MICROTRACE_ISA", GetParam()->name, 1); }
  void TearDown() override { unsetenv("MICROTRACE_ISA"); }
};

INSTANTIATE_TEST_SUITE_P(Isa, DegenerateCost, testing::ValuesIn(kRayKernels.available()),
                         [](const auto& isa) { return std::string(isa.param->name); });

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = std::move(mesh)});
  return scene;
}

// Packets of 64 rays with a common origin, and the same number of incoherent rays, in a cube.
std::vector<Ray> rays_in_cube(float half_width) {
  Random random(31);
  std::vector<Ray> rays;
  const auto add = [&](const Vec3& o, const Vec3& at) { rays.push_back({.o = o, .d = at - o}); };
  for (int tile = 0; tile < 40; ++tile) {
    const Vec3 o = random.in_cube(half_width), at = random.in_cube(half_width);
    for (int i = 0; i < 64; ++i) add(o, at + random.in_cube(0.1F));
    for (int i = 0; i < 64; ++i) add(random.in_cube(half_width), random.in_cube(half_width));
  }
  return rays;
}

// Returns the number of queries that float64 did not decide.
std::uint64_t exact(const StageCounts& counts) {
  return counts.grid + counts.dyadic;
}

struct Cost {
  StageCounts counts;
  std::size_t hits = 0;
};

// Calls every function, including those for ray origins.
Cost ask(const Scene& scene, const std::vector<Ray>& rays) {
  const Bvh bvh(scene);
  const StageCounts before = stage_counts();
  Cost asked;
  std::vector<std::optional<Hit>> hits(rays.size());
  bvh.intersect(rays, hits);
  const auto occluded = std::make_unique<bool[]>(rays.size());
  bvh.occluded(rays, std::span(occluded.get(), rays.size()));
  std::vector<Bvh::Spawn> spawns;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    static_cast<void>(bvh.intersect(rays[i]));
    static_cast<void>(bvh.occluded(rays[i]));
    if (!hits[i]) continue;
    spawns.push_back({.ray = &rays[i], .hit = *hits[i], .direction = rays[i].d});
    spawns.push_back({.ray = &rays[i], .hit = *hits[i], .direction = -rays[i].d});
    ++asked.hits;
  }
  std::vector<std::optional<Vec3>> origins(spawns.size());
  bvh.spawn_origins(spawns, origins);
  asked.counts = stage_counts() - before;
  return asked;
}

void add_triangle(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {a, b, c}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

// Copies all triangles. Each copy has its vertices in a different order.
Mesh copies_of(const Mesh& once, int count) {
  Mesh copies = once;
  for (int copy = 1; copy < count; ++copy) {
    for (auto triangle : once.triangles) {
      std::rotate(triangle.begin(), triangle.begin() + copy % 3, triangle.end());
      if (copy % 2 == 0) std::swap(triangle[0], triangle[1]);
      copies.triangles.push_back(triangle);
    }
  }
  return copies;
}

TEST_P(DegenerateCost, DuplicatesCostNothing) {
  const Mesh once = generated::displaced_sphere(5001);
  const std::vector<Ray> rays = rays_in_cube(1.5F);
  const Cost alone = ask(scene_of(once), rays);
  ASSERT_GT(alone.hits, rays.size() / 4);
  for (const int count : {2, 3, 16}) {
    const Cost asked = ask(scene_of(copies_of(once, count)), rays);
    EXPECT_EQ(asked.hits, alone.hits);
    EXPECT_LE(asked.counts.filters, alone.counts.filters) << count;
    EXPECT_LE(exact(asked.counts), exact(alone.counts)) << count;
  }
}

// Scenes with the first counts are too small for a tree. The scene with the last count has a tree.
TEST_P(DegenerateCost, DuplicatesOfAFewTrianglesCostNothing) {
  Mesh once;
  add_triangle(once, {-1, -1, 0.1F}, {1, -0.9F, 0.3F}, {0.2F, 1, -0.4F});
  add_triangle(once, {-1, -0.8F, -0.1F}, {1, -1, 0.5F}, {-0.4F, 1, 0.7F});
  const std::vector<Ray> rays = rays_in_cube(1.5F);
  const Cost alone = ask(scene_of(once), rays);
  ASSERT_GT(alone.hits, rays.size() / 8);
  for (const int count : {2, 3, 8, 9}) {
    const Cost asked = ask(scene_of(copies_of(once, count)), rays);
    EXPECT_EQ(asked.hits, alone.hits);
    EXPECT_LE(exact(asked.counts), exact(alone.counts)) << count;
  }
}

// The next hit after a hit of a triangle must be that of its copy, at the same t. Rays that leave
// the copy must have the same origins as rays that leave the triangle.
TEST_P(DegenerateCost, HitsOfADuplicateCostNothing) {
  Mesh mesh = generated::displaced_sphere(5001);
  const auto count = static_cast<PrimitiveId>(mesh.triangles.size());
  for (PrimitiveId i = 0; i < count; ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    mesh.triangles.push_back({c, b, a});
  }
  const Scene scene = scene_of(mesh);
  const Bvh bvh(scene);
  std::vector<Ray> rays = rays_in_cube(1.5F);
  std::vector<std::optional<Hit>> hits(rays.size());
  bvh.intersect(rays, hits);
  const StageCounts before = stage_counts();
  std::vector<Bvh::Spawn> firsts, copies;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i]) continue;
    const std::optional<Hit> copy = bvh.next(rays[i], *hits[i]);
    ASSERT_TRUE(copy);
    ASSERT_EQ(copy->id, hits[i]->id + count);
    ASSERT_EQ(copy->t, hits[i]->t);
    firsts.push_back({.ray = &rays[i], .hit = *hits[i], .direction = -rays[i].d});
    copies.push_back({.ray = &rays[i], .hit = *copy, .direction = -rays[i].d});
  }
  ASSERT_GT(firsts.size(), rays.size() / 4);
  std::vector<std::optional<Vec3>> of_firsts(firsts.size()), of_copies(firsts.size());
  EXPECT_EQ(exact(stage_counts() - before), 0U);
  const auto searched_by = [&](const auto& spawns, auto& origins) {
    const StageCounts begin = stage_counts();
    bvh.spawn_origins(spawns, origins);
    return (stage_counts() - begin).searched_origins;
  };
  EXPECT_EQ(searched_by(copies, of_copies), searched_by(firsts, of_firsts));
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    ASSERT_EQ(of_copies[i], of_firsts[i]) << i;
    ASSERT_EQ(bvh.spawn_origin(*copies[i].ray, copies[i].hit, copies[i].direction), of_firsts[i]);
  }
}

// Adds single points among other triangles, on their vertices and beside them. Some scenes have too
// few points for a tree.
TEST_P(DegenerateCost, PointsCostNothing) {
  const std::vector<Ray> rays = rays_in_cube(1.5F);
  const Mesh sphere = generated::displaced_sphere(5000);
  const Cost without = ask(scene_of(sphere), rays);
  Random random(32);
  for (const std::size_t count : {1U, 16U, 17U, 1000U}) {
    Mesh points, mixed = sphere;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = i % 2 == 0 ? random.in_cube(1) : sphere.positions[i];
      add_triangle(points, p, p, p);
      add_triangle(mixed, p, p, p);
    }
    const Cost alone = ask(scene_of(points), rays);
    EXPECT_EQ(alone.hits, 0U);
    EXPECT_EQ(exact(alone.counts), 0U) << count;
    const Cost among = ask(scene_of(mixed), rays);
    EXPECT_EQ(among.hits, without.hits);
    EXPECT_LE(exact(among.counts), exact(without.counts) + 4) << count;
    EXPECT_LE(among.counts.filters, without.counts.filters + 100) << count;
  }
}

// Adds short and long segments: triangles with two vertices at one end, or with one vertex between
// the others.
TEST_P(DegenerateCost, SegmentsCostNothing) {
  const std::vector<Ray> rays = rays_in_cube(1.5F);
  const Mesh sphere = generated::displaced_sphere(5000);
  const Cost without = ask(scene_of(sphere), rays);
  Random random(33);
  for (const float length : {0.02F, 2.0F}) {
    for (const std::size_t count : {1U, 17U, 4000U}) {
      Mesh segments, mixed = sphere;
      for (std::size_t i = 0; i < count; ++i) {
        const Vec3 p = random.on_grid(1024, 0x1p-10F), half = random.on_grid(1024, 0x1p-11F);
        const Vec3 q = p + half * length, r = i % 2 == 0 ? p : p + half * (length * 0.5F);
        add_triangle(segments, p, q, r);
        add_triangle(mixed, p, q, r);
      }
      const Cost alone = ask(scene_of(segments), rays);
      EXPECT_EQ(alone.hits, 0U);
      EXPECT_EQ(exact(alone.counts), 0U) << count;
      const Cost among = ask(scene_of(mixed), rays);
      EXPECT_EQ(among.hits, without.hits);
      EXPECT_LE(exact(among.counts), exact(without.counts) + 4) << count;
      EXPECT_LE(among.counts.searched_origins, without.counts.searched_origins + 4) << count;
    }
  }
}

// Casts rays in the plane of segments and triangles, and rays that start on a segment's line. The
// filters must be certain that these rays miss.
TEST_P(DegenerateCost, RaysInThePlaneCostLittle) {
  Random random(34);
  for (const std::size_t count : {4U, 40U}) {
    Mesh mesh;
    const auto in_plane = [&](float size) {
      const Vec3 p = random.in_cube(size);
      return Vec3(p.x, 0, p.z);
    };
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 a = in_plane(2), b = a + in_plane(0.05F);
      add_triangle(mesh, a, b, i % 2 == 0 ? a : a + in_plane(0.05F));
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 512; ++i) rays.push_back({.o = in_plane(2), .d = in_plane(2)});
    const Cost asked = ask(scene_of(mesh), rays);
    // Every function uses exact arithmetic for rays that hit an edge within the plane.
    EXPECT_LT(exact(asked.counts), 32 * asked.hits + 64) << count;
    EXPECT_LT(asked.hits, rays.size() / 2);
  }
}

}  // namespace
}  // namespace microtrace
