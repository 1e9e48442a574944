// Tests how instances recognize the meshes that they share, and meshes at the limits of instances.

#include "accel/bvh_tree.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/cases/generated_meshes.hpp"
#include "support/cases/placed_scenes.hpp"
#include "support/effort.hpp"
#include "support/hit_by_definition.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/surface_interaction.hpp>

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

TEST(InstancesOfAnAnimation, KeepTheTreesOfTheirMeshes) {
  Random random = traversal::announced_random(70);
  const Mesh mesh = shared_mesh(random);
  const auto frame = [&](double x) {
    PlacedScenes scenes;
    for (int i = 0; i < 3; ++i) {
      Mesh placed = mesh;
      placed.placement =
          std::make_shared<const Placement>(glm::translate(DMat4(1), DVec3(x, 3 * i, 0)));
      scenes.add(placed);
    }
    return scenes;
  };
  const PlacedScenes first = frame(0), second = frame(0.25);
  const Bvh before(first.instanced);
  const Bvh after(second.instanced, {.previous = before.tree()});
  ASSERT_EQ(after.tree()->tree.instances.size(), 3U);
  EXPECT_EQ(after.tree()->tree.meshes, before.tree()->tree.meshes);
  const Bvh copies(second.baked);
  for (const Ray& ray : unrelated_rays(random, second.baked, 500))
    ASSERT_TRUE(same(after.intersect(ray), copies.intersect(ray)));
}

TEST(InstancesOfAnAnimation, AreThoseOfChangedVertices) {
  // A mesh with one owner may be changed by a reference that edit() returned before a tree was
  // made.
  Scene scene;
  Mesh quad{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
            .triangles = {{0, 1, 2}, {0, 2, 3}}};
  quad.placement = std::make_shared<const Placement>(DMat4(1));
  scene.objects.push_back({.name = "", .shape = std::move(quad)});
  std::vector<Vec3>& positions = std::get<Mesh>(scene.objects[0].shape).positions.edit();
  const Ray ray{.o = {0.25F, 0.5F, 5}, .d = {0, 0, -1}};
  std::shared_ptr<const BvhTree> last;
  for (const float z : {0.0F, 2.0F, 9.0F, -1.0F}) {
    for (Vec3& p : positions) p.z = z;
    const Bvh bvh(scene, {.previous = last});
    const auto hit = bvh.intersect(ray);
    ASSERT_EQ(hit.has_value(), z < 5);
    if (hit) {
      EXPECT_EQ(hit->t, 5 - z);
    }
    last = bvh.tree();
  }
}

TEST(InstancesOfTinyMeshes, AreHitLikeCopies) {
  Random random = traversal::announced_random(80);
  std::size_t hits = 0;
  for (const int exponent : {-149, -145, -140, -130, -110, -100, -90}) {
    SCOPED_TRACE(exponent);
    PlacedScenes scenes;
    Mesh mesh = generated::displaced_sphere(300);
    for (Vec3& p : mesh.positions.edit())
      for (int k = 0; k < 3; ++k) p[k] = std::ldexp(std::rint(8 * p[k]), exponent);
    for (int i = 0; i < 2; ++i) {
      const DMat4 m = adversarial::placement(random, PlacementKind::rigid);
      mesh.placement = std::make_shared<const Placement>(glm::scale(DMat4(1), DVec3(30000)) *
                                                         DMat4(glm::dmat3(m)));
      scenes.add(mesh);
    }
    const Bvh bvh(scenes.instanced), copies(scenes.baked);
    for (int i = 0; i < 3000; ++i) {
      const auto point = [&](float size) {
        return std::ldexp(size * 30000, exponent) * random.in_cube(1);
      };
      const Vec3 o = point(30);
      const Ray ray{.o = o, .d = glm::normalize(std::ldexp(1.0F, -exponent) * (point(8) - o))};
      const auto hit = bvh.intersect(ray), expected = copies.intersect(ray);
      ASSERT_TRUE(same(hit, expected)) << i;
      hits += expected ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 2000U);
}

// GCC 12.2 once omitted the rounding of an instance's normals to float32 here.
TEST(SurfacesOfInstances, EqualThoseOfCopies) {
  Random random = traversal::announced_random(81);
  std::size_t hits = 0;
  for (const PlacementKind kind : kPlacementKinds) {
    SCOPED_TRACE(name(kind));
    for (int round = 0; round < 20; ++round) {
      Mesh mesh = generated::displaced_sphere(300);
      std::vector<Vec3> normals;
      std::vector<Vec2> uv;
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        normals.push_back(glm::normalize(random.in_cube(1)));
        uv.emplace_back(random.in_cube(1));
      }
      mesh.normals = std::move(normals);
      mesh.uv_sets = {std::move(uv)};
      mesh.placement = std::make_shared<const Placement>(placement(random, kind));
      PlacedScenes scenes;
      scenes.add(mesh);
      const Bvh instance(scenes.instanced), copy(scenes.baked);
      for (const Ray& ray : unrelated_rays(random, scenes.baked, 50)) {
        const std::optional<Hit> hit = instance.intersect(ray);
        ASSERT_TRUE(same(hit, copy.intersect(ray)));
        if (!hit) continue;
        ++hits;
        const SurfaceInteraction at = interact(instance.primitives(), ray, *hit);
        const SurfaceInteraction expected = interact(copy.primitives(), ray, *hit);
        ASSERT_EQ(at.p, expected.p);
        ASSERT_EQ(at.n, expected.n);
        ASSERT_EQ(at.ns, expected.ns);
        ASSERT_EQ(at.front, expected.front);
        ASSERT_EQ(at.uv(0), expected.uv(0));
        ASSERT_EQ(at.uv_step(0, DVec3(0.1, 0.2, 0.3)), expected.uv_step(0, DVec3(0.1, 0.2, 0.3)));
      }
    }
  }
  EXPECT_GT(hits, 500U);
}

TEST(InstancesThatBeginAlike, AreFramedByAllOfTheirVertices) {
  const auto mesh = [](const std::vector<Vec3>& points, std::size_t size) {
    Mesh result{.positions = Array<Vec3>::borrow(std::span(points).first(size)),
                .triangles = {{0, 1, 2}, {0, 1, static_cast<std::uint32_t>(size - 1)}}};
    result.placement = std::make_shared<const Placement>(DMat4(1));
    return result;
  };
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.emplace_back(i, i % 7, i % 3);
  const std::vector<Vec3> others = points;
  const auto camera = [&](const std::vector<Vec3>& second) {
    Scene scene;
    scene.objects.push_back({.name = "", .shape = mesh(points, 3)});
    scene.objects.push_back({.name = "", .shape = mesh(second, 300)});
    return frame(scene, View{}, {.width = 64, .height = 48});
  };
  EXPECT_EQ(camera(points).pose.position, camera(others).pose.position);
}

}  // namespace
}  // namespace microtrace
