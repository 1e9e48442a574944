// Compares queries of many rays and points with tests of all primitives.

#include "exact/crossing.hpp"
#include "exact/first_hit.hpp"
#include "exact/nearest.hpp"
#include "queries/locator.hpp"
#include "simd/instruction_set.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/cases/closed_bodies.hpp"
#include "support/cases/generated_meshes.hpp"
#include "support/cases/solid_cases.hpp"
#include "support/effort.hpp"

#include <microtrace/error.hpp>
#include <microtrace/queries.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

Scene queried_scene(Mesh mesh) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = std::move(mesh)});
  return scene;
}

// Returns the hits that PreparedScene::next enumerates. The tests Next.* compare these with all
// exact roots.
std::vector<Hit> one_after_another(const PreparedScene& scene, const Ray& ray) {
  std::vector<Hit> hits;
  for (auto hit = scene.intersect(ray); hit; hit = scene.next(ray, *hit)) hits.push_back(*hit);
  return hits;
}

void expect_equal_hits(const PreparedScene& scene, const std::vector<Ray>& rays) {
  const RayHits all = intersect_all(scene, rays);
  std::vector<std::uint32_t> counts(rays.size());
  count_crossings(scene, rays, counts);
  ASSERT_EQ(all.rays(), rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::vector<Hit> expected = one_after_another(scene, rays[i]);
    const auto equal = [](const Hit& x, const Hit& y) { return x.id == y.id && x.t == y.t; };
    ASSERT_TRUE(std::ranges::equal(all.of(i), expected, equal)) << i;
    ASSERT_EQ(counts[i], expected.size()) << i;
  }
}

TEST(AllHits, AreThoseOfRepeatedNext) {
  Random random(61);
  for (int round = 0; round < 60; ++round) {
    Scene scene = random_scene(random);
    if (round % 3 == 0) {
      // Adds duplicates. Some hits of other shapes have the same t.
      for (int copy = 0; copy < 30; ++copy) {
        const auto last = static_cast<int>(scene.objects.size()) - 1;
        const Object object = scene.objects[static_cast<std::size_t>(random.between(0, last))];
        scene.objects.insert(scene.objects.begin() + random.between(0, last), object);
      }
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 24; ++i) rays.push_back(random_ray(random, scene, origin(random, scene)));
    expect_equal_hits(PreparedScene(std::move(scene)), rays);
    ASSERT_FALSE(HasFatalFailure()) << "scene " << round;
  }
}

TEST(AllHits, OfRaysBeyondTheLimitsOfKernels) {
  Random random(62);
  for (const float size : {0x1p-140F, 0x1p-60F, 0x1p60F, 0x1p120F}) {
    for (const BodyKind kind : kBodyKinds) {
      const Vec3 center = random.in_cube(size);
      const PreparedScene scene(queried_scene(closed_body(random, kind, center, size)));
      std::vector<Ray> rays;
      for (int i = 0; i < 20; ++i) {
        rays.push_back({.o = center + random.in_cube(2 * size),
                        .t_min = 0,
                        .d = random.in_cube(i % 2 == 0 ? 1 : size)});
      }
      rays.push_back({.o = {std::numeric_limits<float>::quiet_NaN(), 0, 0}});
      rays.push_back({.o = center, .d = Vec3(0)});
      expect_equal_hits(scene, rays);
      ASSERT_FALSE(HasFatalFailure()) << name(kind) << " of size " << size;
    }
  }
}

TEST(AllHits, OfNoRays) {
  const PreparedScene scene{Scene{}};
  EXPECT_EQ(intersect_all(scene, {}).rays(), 0U);
  const Ray ray;
  EXPECT_TRUE(intersect_all(scene, std::span(&ray, 1)).of(0).empty());
}

// Compares the results of every kernel. The other tests use only the kernel that the library
// selects.
TEST(Queries, HaveTheSameResultsWithAllInstructionSets) {
  Random random(65);
  Scene scene = random_scene(random);
  scene.objects.push_back({.name = "", .shape = generated::turned(generated::hall(3000))});
  const PreparedScene prepared(std::move(scene));
  std::vector<Ray> rays;
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) {
    rays.push_back(random_ray(random, prepared.scene(), origin(random, prepared.scene())));
    points.push_back(rays.back().o + random.in_cube(1));
  }
  struct Results {
    RayHits hits;
    std::vector<Location> locations;
    std::vector<std::optional<NearestPoint>> nearest;
  };
  std::optional<Results> expected;
  for (const InstructionSet isa : available_instruction_sets()) {
    setenv("MICROTRACE_ISA", std::string(name_of(isa)).c_str(), 1);
    Results results{.hits = intersect_all(prepared, rays),
                    .locations = std::vector<Location>(points.size()),
                    .nearest = std::vector<std::optional<NearestPoint>>(points.size())};
    const Solid solid(prepared);
    solid.locate(points, results.locations);
    solid.nearest_points(points, results.nearest);
    unsetenv("MICROTRACE_ISA");
    if (!expected) expected = results;
    EXPECT_EQ(results.hits.offsets, expected->hits.offsets);
    EXPECT_EQ(results.locations, expected->locations);
    for (std::size_t i = 0; i < expected->hits.hits.size(); ++i) {
      ASSERT_EQ(results.hits.hits[i].id, expected->hits.hits[i].id);
      ASSERT_EQ(results.hits.hits[i].t, expected->hits.hits[i].t);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(results.nearest[i]->id, expected->nearest[i]->id);
      ASSERT_EQ(results.nearest[i]->distance, expected->nearest[i]->distance);
      ASSERT_EQ(results.nearest[i]->p, expected->nearest[i]->p);
    }
  }
}

// ---- Points

Location location_by_definition(const Mesh& mesh, const Vec3& p, Random& random) {
  while (true) {
    const Vec3 d = random.in_cube(1);
    if (d == Vec3(0)) continue;
    std::size_t count = 0;
    bool is_grazing = false;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      switch (exact::crossing(triangle_of(mesh, i), p, d)) {
        case exact::Crossing::origin:
          return Location::boundary;
        case exact::Crossing::proper:
          ++count;
          break;
        case exact::Crossing::grazing:
          is_grazing = true;
          break;
        case exact::Crossing::none:
          break;
      }
    }
    if (!is_grazing) return count % 2 == 1 ? Location::inside : Location::outside;
  }
}

TEST(Solid, LocatesPointsAsATestOfAllTriangles) {
  Random random = traversal::announced_random(63);
  const auto per_body = static_cast<int>(traversal::ray_count(0.04) / 192) + 1;
  std::size_t all = 0, inside = 0, boundary = 0;
  for (const SolidCase& solid_case : solid_cases(random, 3)) {
    SCOPED_TRACE(solid_case.name);
    const Mesh& mesh = solid_case.mesh;
    const Solid solid{PreparedScene(queried_scene(mesh))};
    EXPECT_TRUE(solid.is_closed());
    std::vector<Vec3> points;
    for (int i = 0; i < per_body; ++i) points.push_back(point_about(random, solid_case));
    all += points.size();
    std::vector<Location> locations(points.size());
    solid.locate(points, locations);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(locations[i], location_by_definition(mesh, points[i], random)) << i;
      inside += locations[i] == Location::inside ? 1 : 0;
      boundary += locations[i] == Location::boundary ? 1 : 0;
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(inside, all / 10);
  EXPECT_GT(boundary, all / 10);
}

// The first ray from the origin passes exactly through a vertex of the octahedron, and through the
// middle of an edge of the tetrahedron.
TEST(Solid, TriesAnotherRayAtEdgesAndVertices) {
  // Uses empty bounds, because the tree of a few triangles has none.
  const Vec3 d = crossing_direction(Bounds(), Vec3(0), 0);
  const Mesh octahedron{
      .positions = {d, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}, -d},
      .triangles = {
          {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {5, 2, 1}, {5, 3, 2}, {5, 4, 3}, {5, 1, 4}}};
  const Mesh tetrahedron{
      .positions = {{d.x, 2 * d.y, d.z}, {d.x, 0, d.z}, -d + Vec3(0, 0, 3), -d - Vec3(0, 0, 3)},
      .triangles = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}}};
  Random random(66);
  for (const Mesh& mesh : {octahedron, tetrahedron}) {
    bool is_grazing = false;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      is_grazing |= exact::crossing(triangle_of(mesh, i), Vec3(0), d) == exact::Crossing::grazing;
    EXPECT_TRUE(is_grazing);
    const Vec3 p(0);
    Location location = Location::outside;
    Solid{PreparedScene(queried_scene(mesh))}.locate(std::span(&p, 1), std::span(&location, 1));
    EXPECT_EQ(location, location_by_definition(mesh, p, random));
    EXPECT_EQ(location, Location::inside);
  }
}

TEST(Solid, FindsTheNearestOfAllTriangles) {
  Random random = traversal::announced_random(64);
  const auto per_body = static_cast<int>(traversal::ray_count(0.01) / 192) + 1;
  for (const SolidCase& solid_case : solid_cases(random, 3)) {
    SCOPED_TRACE(solid_case.name);
    const Mesh& mesh = solid_case.mesh;
    const Solid solid{PreparedScene(queried_scene(mesh))};
    std::vector<Vec3> points;
    for (int i = 0; i < per_body; ++i) points.push_back(point_about(random, solid_case));
    std::vector<std::optional<NearestPoint>> nearest(points.size());
    solid.nearest_points(points, nearest);
    std::vector<double> distances(points.size());
    solid.signed_distances(points, distances);
    std::vector<Location> locations(points.size());
    solid.locate(points, locations);
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::optional<exact::Nearest> best;
      PrimitiveId best_id = 0;
      for (PrimitiveId id = 0; id < mesh.triangles.size(); ++id) {
        const exact::Nearest found = exact::nearest(triangle_of(mesh, id), points[i]);
        if (best && compare_distances(found, *best) >= 0) continue;
        best = found;
        best_id = id;
      }
      ASSERT_TRUE(nearest[i].has_value());
      ASSERT_EQ(nearest[i]->id, best_id) << i;
      const double exact_distance = exact::distance(*best);
      ASSERT_NEAR(nearest[i]->distance, exact_distance, 0x1p-38 * exact_distance) << i;
      ASSERT_EQ(nearest[i]->distance == 0, locations[i] == Location::boundary) << i;
      ASSERT_EQ(distances[i],
                locations[i] == Location::inside ? -nearest[i]->distance : nearest[i]->distance);
      const Triangle t = triangle_of(mesh, best_id);
      const DVec3 weights = exact::barycentrics(*best);
      const DVec3 p = weights.x * DVec3(t.a) + weights.y * DVec3(t.b) + weights.z * DVec3(t.c);
      double size = 0, coordinates = 0;
      for (const Vec3& v : {t.a, t.b, t.c}) {
        for (int k = 0; k < 3; ++k) {
          size = std::max(size, std::abs(double{v[k]} - double{points[i][k]}));
          coordinates = std::max(coordinates, std::abs(double{v[k]}));
        }
      }
      const DVec3 difference = glm::abs(nearest[i]->p - p);
      const double most = std::max({difference.x, difference.y, difference.z});
      ASSERT_LE(most, 0x1p-40 * size + 0x1p-50 * coordinates) << i;
    }
  }
}

}  // namespace
}  // namespace microtrace
