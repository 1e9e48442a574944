// Checks that a scene with instances gives the results of the same scene with transformed copies of
// the meshes, bit for bit: for each kernel that the machine supports and for every query.
// MICROTRACE_TRAVERSAL_RAYS scales the number of rays.

#include "accel/bvh_tree.hpp"
#include "accel/instances/dispatch.hpp"
#include "accel/kernels/dispatch.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/cases/placed_scenes.hpp"
#include "support/effort.hpp"
#include "support/hit_by_definition.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/queries.hpp>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

std::uint32_t bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

testing::AssertionResult same(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  const bool equal =
      a.has_value() == b.has_value() &&
      (!a || (bits(a->x) == bits(b->x) && bits(a->y) == bits(b->y) && bits(a->z) == bits(b->z)));
  return equal ? testing::AssertionSuccess() : testing::AssertionFailure() << "other origins";
}

std::vector<Ray> rays_for(Random& random, const Scene& scene, int count) {
  std::vector<Ray> rays = unrelated_rays(random, scene, count);
  for (int tile = random.between(0, 4); tile > 0; --tile) {
    const Vec3 o = origin(random, scene);
    const Ray middle = random_ray(random, scene, o);
    for (int i = random.between(1, 64); i > 0; --i) {
      rays.push_back(middle);
      rays.back().d = random.jitter(middle.d, 1 << random.between(0, 20));
    }
  }
  return rays;
}

/// Answers to all queries of rays.
struct Answers {
  std::vector<std::optional<Hit>> hits, next;
  std::vector<bool> occluded;
  std::vector<std::optional<Vec3>> origins;

  Answers(const Bvh& bvh, const std::vector<Ray>& rays, Random random)
      : hits(rays.size()), next(rays.size()), occluded(rays.size()) {
    bvh.intersect(rays, hits);
    const auto results = std::make_unique<bool[]>(rays.size());
    bvh.occluded(rays, std::span(results.get(), rays.size()));
    std::vector<Bvh::Spawn> spawns;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      occluded[i] = results[i];
      if (!hits[i]) continue;
      next[i] = bvh.next(rays[i], *hits[i]);
      spawns.push_back({.ray = &rays[i], .hit = *hits[i], .direction = random.in_cube(1)});
    }
    origins.resize(spawns.size());
    bvh.spawn_origins(spawns, origins);
  }
};

class Instances : public testing::TestWithParam<PlacementKind> {};

INSTANTIATE_TEST_SUITE_P(Placements, Instances, testing::ValuesIn(kPlacementKinds),
                         [](const auto& kind) { return std::string(name(kind.param)); });

TEST_P(Instances, EqualTransformedCopiesForEveryKernelAndQuery) {
  const auto number = static_cast<std::uint64_t>(GetParam());
  Random random = traversal::announced_random(40 + number);
  const std::size_t count = traversal::ray_count(0.1 / kPlacementKinds.size()) + 1;
  std::size_t cast = 0, hits = 0, origins = 0, instances = 0;
  // The meshes of many scenes can't be instances, so few rays may not suffice.
  for (int round = 0; cast < count || (instances == 0 && round < 1000); ++round) {
    SCOPED_TRACE(round);
    const PlacedScenes scenes = random_placed_scenes(random, GetParam());
    const std::vector<Ray> rays =
        rays_for(random, scenes.baked, random.one_in(12) ? 2500 : random.between(20, 300));
    const Bvh copies(scenes.baked);
    const Random directions = random;
    const Answers expected(copies, rays, directions);
    for (const Kernels* kernels : kRayKernels.available()) {
      SCOPED_TRACE(kernels->name);
      setenv("MICROTRACE_ISA", kernels->name, 1);
      const Bvh bvh(scenes.instanced);
      instances += bvh.tree()->tree.instances.size();
      const auto box = bvh.bounds(), same_box = copies.bounds();
      ASSERT_EQ(box.has_value(), same_box.has_value());
      if (box) {
        ASSERT_EQ(box->lo, same_box->lo);
        ASSERT_EQ(box->hi, same_box->hi);
      }
      const Answers actual(bvh, rays, directions);
      unsetenv("MICROTRACE_ISA");
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same(actual.hits[i], expected.hits[i])) << "ray " << i;
        ASSERT_TRUE(same(actual.next[i], expected.next[i])) << "ray " << i;
        ASSERT_EQ(actual.occluded[i], expected.occluded[i]) << "ray " << i;
        if (i % 16 != 0) continue;
        ASSERT_TRUE(same(bvh.intersect(rays[i]), expected.hits[i])) << "ray " << i;
        ASSERT_EQ(bvh.occluded(rays[i]), expected.occluded[i]) << "ray " << i;
        if (expected.hits[i]) ++hits;
      }
      for (std::size_t i = 0; i < expected.origins.size(); ++i)
        ASSERT_TRUE(same(actual.origins[i], expected.origins[i])) << "origin " << i;
      for (int i = 0; i < 20; ++i) {
        const Vec3 p = origin(random, scenes.baked);
        ASSERT_EQ(bvh.is_clear(p), copies.is_clear(p));
      }
    }
    cast += rays.size();
    origins += expected.origins.size();
  }
  EXPECT_GT(hits, count / 128);
  EXPECT_GT(origins, count / 16);
  EXPECT_GT(instances, 0U);
}

TEST_P(Instances, QueriesOfPointsAndAllHitsEqualThoseOfCopies) {
  Random random = traversal::announced_random(50 + static_cast<std::uint64_t>(GetParam()));
  std::size_t hits = 0;
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(round);
    const PlacedScenes scenes = random_placed_scenes(random, GetParam());
    const std::vector<Ray> rays = rays_for(random, scenes.baked, 100);
    std::vector<Vec3> points;
    for (int i = 0; i < 50; ++i) points.push_back(origin(random, scenes.baked));
    const PreparedScene instanced(scenes.instanced), copied(scenes.baked);
    const RayHits all = intersect_all(instanced.bvh(), rays);
    const RayHits expected = intersect_all(copied.bvh(), rays);
    ASSERT_EQ(all.offsets, expected.offsets);
    for (std::size_t i = 0; i < all.hits.size(); ++i)
      ASSERT_TRUE(same(all.hits[i], expected.hits[i])) << "hit " << i;
    hits += all.hits.size();
    std::vector<std::optional<NearestPoint>> nearest(points.size()), nearest_copies(points.size());
    std::vector<Location> locations(points.size()), locations_of_copies(points.size());
    const Solid solid(instanced), copy(copied);
    solid.nearest_points(points, nearest);
    copy.nearest_points(points, nearest_copies);
    solid.locate(points, locations);
    copy.locate(points, locations_of_copies);
    ASSERT_EQ(locations, locations_of_copies);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(nearest[i].has_value(), nearest_copies[i].has_value());
      if (!nearest[i]) continue;
      ASSERT_EQ(nearest[i]->id, nearest_copies[i]->id);
      ASSERT_EQ(nearest[i]->p, nearest_copies[i]->p);
    }
  }
  EXPECT_GT(hits, 1000U);
}

TEST_P(Instances, BoxesOfOnePointFindTheTrianglesOfVertices) {
  Random random = traversal::announced_random(60 + static_cast<std::uint64_t>(GetParam()));
  std::size_t found = 0;
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    const PlacedScenes scenes = random_placed_scenes(random, GetParam());
    const Bvh bvh(scenes.instanced);
    const Tree& tree = bvh.tree()->tree;
    if (tree.instances.empty()) continue;
    const TreeView view{.nodes = tree.nodes.data(),
                        .blocks = tree.blocks.data(),
                        .others = tree.others.data(),
                        .root = tree.root,
                        .instances = tree.instances.data(),
                        .meshes = tree.views.data(),
                        .scene_block = kInstanceKernels.best().scene_block};
    for (int i = 0; i < 200; ++i) {
      const Instance& instance =
          tree.instances[random.bits() % static_cast<std::uint32_t>(tree.instances.size())];
      const PrimitiveId id =
          instance.first_id + random.bits() % tree.views[instance.mesh].triangles;
      const auto triangle = bvh.primitives().triangle(id);
      if (!std::isfinite(triangle->a.x + triangle->a.y + triangle->a.z)) continue;
      for (const Kernels* kernels : kRayKernels.available()) {
        BoxQueries query{};
        query.size = 1;
        for (int k = 0; k < 3; ++k) query.lo[k][0] = query.hi[k][0] = triangle->a[k];
        query.omitted_id[0] = kNoPrimitive;
        query.plane_axis[0] = -1;
        kernels->touching(view, query);
        const auto is_found = [&] {
          for (int k = 0; k < query.count[0]; ++k)
            if (query.slots[0][k] == kIdSlot && query.ids[0][k] == id) return true;
          return query.count[0] < 0;  // too many
        };
        ASSERT_TRUE(is_found()) << kernels->name << ", triangle " << id;
        ++found;
      }
    }
  }
  EXPECT_GT(found, 1000U);
}

}  // namespace
}  // namespace microtrace
