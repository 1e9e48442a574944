// Queries of many rays and points, compared with a test of all primitives.

#include "exact/crossing.hpp"
#include "exact/intersect.hpp"
#include "exact/nearest.hpp"
#include "support/adversarial_scenes.hpp"
#include "support/closed_bodies.hpp"
#include "support/effort.hpp"

#include <microtrace/error.hpp>
#include <microtrace/queries.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = std::move(mesh)});
  return scene;
}

// The hits that PreparedScene::next enumerates, which Next.* compares with all exact roots.
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
  for (int round = 0; round < 150; ++round) {
    Scene scene = random_scene(random);
    if (round % 3 == 0) {
      // Duplicates, also among others with the same t.
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
      const PreparedScene scene(scene_of(closed_body(random, kind, center, size)));
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

// On vertices, on edges, on faces, one ulp beside them, near them, and anywhere.
Vec3 point_about(Random& random, const Mesh& mesh, const Vec3& center, float size) {
  const auto count = static_cast<int>(mesh.triangles.size());
  const Triangle t = triangle_of(mesh, static_cast<std::size_t>(random.between(0, count - 1)));
  const auto ulps = [&](Vec3 p, int most) {
    for (int k = 0; k < 3; ++k) {
      for (int step = random.between(-most, most); step != 0; step += step < 0 ? 1 : -1)
        p[k] = std::nextafter(p[k], step < 0 ? -INFINITY : INFINITY);
    }
    return p;
  };
  const float s = static_cast<float>(random.between(0, 8)) / 8;
  const float r = static_cast<float>(random.between(0, 8)) / 8;
  switch (random.between(0, 6)) {
    case 0:
      return t.a;
    case 1:
      return ulps(t.b, 1);
    case 2:
      return t.a + s * (t.b - t.a);
    case 3:
      return ulps(t.b + s * (t.c - t.b), 1);
    case 4:
      return t.a + s * (t.b - t.a) + r * (1 - s) * (t.c - t.a);
    case 5:
      return ulps(t.a + s * (t.b - t.a) + r * (1 - s) * (t.c - t.a), 3);
    default:
      return center + random.in_cube(1.5F * size);
  }
}

struct Place {
  Vec3 center;
  float size;
};

std::vector<Place> places() {
  return {{Vec3(0), 1},          {Vec3(0), 0x1p-44F},      {Vec3(0), 0x1p-130F},
          {{1, 2, 3}, 0x1p-44F}, {{1000, -2000, 3000}, 1}, {{0x1p20F, 0x1p21F, 0}, 100},
          {Vec3(0), 0x1p50F},    {Vec3(0), 0x1p110F}};
}

template <class F>
void for_each_body(Random& random, int rounds, const F& f) {
  for (int round = 0; round < rounds; ++round) {
    for (const Place& place : places()) {
      for (const BodyKind kind : kBodyKinds) {
        SCOPED_TRACE(testing::Message()
                     << name(kind) << ", size " << place.size << ", round " << round);
        Mesh mesh = closed_body(random, kind, place.center, place.size);
        // Another body inside, or across.
        if (random.one_in(3)) {
          const Mesh other = closed_body(random, kind, place.center, 0.5F * place.size);
          const auto first = static_cast<std::uint32_t>(mesh.positions.size());
          for (const Vec3& p : other.positions) mesh.positions.push_back(p);
          for (const auto& [a, b, c] : other.triangles)
            mesh.triangles.push_back({a + first, b + first, c + first});
        }
        f(mesh, place);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

TEST(Solid, LocatesPointsAsATestOfAllTriangles) {
  Random random = traversal::announced_random(63);
  const auto per_body = static_cast<int>(traversal::ray_count(0.04) / 192) + 1;
  std::size_t inside = 0, boundary = 0;
  for_each_body(random, 3, [&](const Mesh& mesh, const Place& place) {
    const Solid solid{PreparedScene(scene_of(mesh))};
    EXPECT_TRUE(solid.is_closed());
    std::vector<Vec3> points;
    for (int i = 0; i < per_body; ++i)
      points.push_back(point_about(random, mesh, place.center, place.size));
    std::vector<Location> locations(points.size());
    solid.locate(points, locations);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(locations[i], location_by_definition(mesh, points[i], random)) << i;
      inside += locations[i] == Location::inside ? 1 : 0;
      boundary += locations[i] == Location::boundary ? 1 : 0;
    }
  });
  EXPECT_GT(inside, 1000U);
  EXPECT_GT(boundary, 1000U);
}

TEST(Solid, FindsTheNearestOfAllTriangles) {
  Random random = traversal::announced_random(64);
  const auto per_body = static_cast<int>(traversal::ray_count(0.01) / 192) + 1;
  for_each_body(random, 3, [&](const Mesh& mesh, const Place& place) {
    const Solid solid{PreparedScene(scene_of(mesh))};
    std::vector<Vec3> points;
    for (int i = 0; i < per_body; ++i)
      points.push_back(point_about(random, mesh, place.center, place.size));
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
  });
}

}  // namespace
}  // namespace microtrace
