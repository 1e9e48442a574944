// Checks that a host program's rounding mode, precision and flushing of subnormals change no hit
// and no surface.

#include "support/cases/adversarial_rays.hpp"
#include "support/cases/generated_meshes.hpp"
#include "support/host_rules.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/dataset.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/queries.hpp>
#include <microtrace/spawn.hpp>
#include <microtrace/surface_interaction.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

class HostRulesOfHits : public tests::HostRules {};

INSTANTIATE_TEST_SUITE_P(Rounding, HostRulesOfHits,
                         testing::Values(FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO));

// Differences of ray origins and the scene's origin are rounded. If subnormals were flushed to
// zero, the vertices of the solid would coincide.
TEST_P(HostRulesOfHits, ChangeNoRayInTheSceneAndNoEdge) {
  constexpr float kLeast = std::numeric_limits<float>::denorm_min();
  Scene scene;
  scene.objects.push_back({.shape = Triangle{{0, 0, 0}, {kLeast, 0, 0}, {0, kLeast, 0}}});
  const auto counts = [&] {
    const Solid solid{PreparedScene(scene)};
    return std::pair(solid.is_closed(), solid.open_edges().size());
  };
  Scene moved = scene;
  moved.origin = {1e6, 1e-3, 0};
  const PreparedScene prepared(moved);
  const Ray ray{.o = {0.1F, 0.1F, 0.7F}, .d = {0, 0, 1}};
  const Vec3 expected = prepared.in_scene(ray).o;
  set();
  const Vec3 actual = prepared.in_scene(ray).o;
  const std::pair<bool, std::size_t> edges = counts();
  expect_kept();
  TearDown();
  EXPECT_EQ(actual, expected);
  EXPECT_EQ(edges, std::pair(false, std::size_t{3}));
}

// The triangle is smaller than the least normal number. If subnormals were flushed to zero, it
// would be a point.
TEST_P(HostRulesOfHits, ChangeNoHit) {
  constexpr float kLeast = std::numeric_limits<float>::denorm_min();
  Scene scene;
  const Triangle tiny{Vec3(-2 * kLeast, -2 * kLeast, 0), Vec3(3 * kLeast, 0, 0),
                      Vec3(0, 3 * kLeast, 0)};
  for (int i = 0; i < 20; ++i) scene.objects.push_back({.name = "", .shape = tiny});
  const Ray ray{.o = {kLeast, kLeast, 1}, .d = {0, 0, -1}};
  for (const std::size_t count : {std::size_t{1}, std::size_t{20}}) {
    scene.objects.resize(count, {.name = "", .shape = tiny});
    set();
    const Bvh bvh(scene);
    const auto hit = bvh.intersect(ray);
    const bool occluded = bvh.occluded(ray);
    const std::vector<Ray> rays(64, ray);
    std::vector<std::optional<Hit>> hits(64);
    bvh.intersect(rays, hits);
    expect_kept();
    TearDown();
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->id, 0U);
    EXPECT_EQ(hit->t, 1);
    EXPECT_TRUE(occluded);
    EXPECT_TRUE(
        std::all_of(hits.begin(), hits.end(), [](const auto& h) { return h && h->id == 0; }));
  }
}

TEST_P(HostRulesOfHits, ChangeNoParameter) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = generated::displaced_sphere(5000)});
  const Bvh bvh(scene);
  adversarial::Random random(5);
  std::vector<Ray> rays(1000);
  for (Ray& ray : rays) ray = {.o = random.in_cube(3), .d = random.in_cube(1)};
  for (std::size_t i = 500; i < 564; ++i) rays[i].o = rays[500].o;  // a packet
  std::vector<std::optional<Hit>> expected(rays.size()), together(rays.size()), singly;
  bvh.intersect(rays, expected);
  set();
  bvh.intersect(rays, together);
  for (const Ray& ray : rays) singly.push_back(bvh.intersect(ray));
  expect_kept();
  TearDown();
  const auto same = [](const std::optional<Hit>& a, const std::optional<Hit>& b) {
    return a.has_value() == b.has_value() && (!a || (a->id == b->id && a->t == b->t));
  };
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), together.begin(), same));
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), singly.begin(), same));
}

// Tests the functions of single hits, and those that make a scene or a data set.
TEST_P(HostRulesOfHits, ChangeNoSurface) {
  adversarial::Random random(6);
  Mesh mesh = generated::displaced_sphere(500);
  std::vector<Vec3> normals;
  std::vector<Vec2> uv;
  std::vector<Vec4> colors;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    normals.push_back(random.in_cube(1));
    uv.emplace_back(random.in_cube(1));
    colors.emplace_back(random.in_cube(1), 0.7F);
  }
  mesh.normals = std::move(normals);
  mesh.uv_sets = {std::move(uv)};
  mesh.colors = std::move(colors);
  const DMat4 turned(glm::rotate(DMat4(1), 0.7, DVec3(0.1, 0.2, 0.3)));
  mesh.placement = std::make_shared<const Placement>(turned);
  Scene scene;
  scene.objects.push_back({.name = "", .shape = mesh});
  const Bvh bvh(scene);
  std::vector<Ray> rays(200);
  for (Ray& ray : rays) {
    ray.o = random.in_cube(2);
    ray.d = random.in_cube(0.2F) - ray.o;
  }
  const auto steps = [&] {
    std::vector<double> numbers;
    const auto add = [&](const auto& vector) {
      numbers.insert(numbers.end(), {vector.x, vector.y, vector.z});
    };
    for (const Ray& ray : rays) {
      const std::optional<Hit> hit = bvh.intersect(ray);
      if (!hit) continue;
      const SurfaceInteraction at = interact(bvh.primitives(), ray, *hit);
      add(at.p);
      add(at.ns);
      add(at.color());
      add(DVec3(at.uv(0).value(), 0));
      add(DVec3(at.uv_step(0, DVec3(0.1, 0.2, 0.3)), 0));
      if (const auto o = spawn_origin(bvh.primitives(), hit->id, ray, Vec3(0.1F, 0.7F, 0.2F)))
        add(*o);
    }
    for (const Vec3& p : baked(mesh).positions) add(p);
    for (const auto& views : {random_views(20, 1), hemisphere_views(20), orbit_views(7, 25)})
      for (const DatasetView& view : views) {
        const View& from = std::get<View>(view.camera);
        add(DVec3(from.azimuth, from.elevation, from.vertical_fov));
      }
    return numbers;
  };
  const std::vector<double> expected = steps();
  ASSERT_GT(expected.size(), 3000U);
  set();
  const std::vector<double> actual = steps();
  expect_kept();
  TearDown();
  EXPECT_EQ(actual, expected);
}

}  // namespace
}  // namespace microtrace
