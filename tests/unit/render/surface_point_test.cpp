#include "render/shading/points/surface_point.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/scene.hpp>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// A triangle in the plane z = 0 whose vertices have texture coordinates and colors.
Scene scene_of_a_triangle() {
  Scene scene;
  scene.objects.push_back({.shape = Mesh{.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                                         .triangles = {{{0, 1, 2}}},
                                         .uv_sets = {{{0.25F, 0.5F}, {0.75F, 0.5F}, {0.25F, 1}}},
                                         .colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}}}});
  return scene;
}

TEST(SurfacePoint, EdgeOnTrianglesKeepTheirAttributes) {
  const Scene scene = scene_of_a_triangle();
  const Bvh bvh(scene);
  const auto& mesh = std::get<Mesh>(scene.objects[0].shape);
  // The ray lies in the plane and enters the triangle at (3, 1, 0).
  const Ray ray{.o = {5, 1, 0}, .d = {-1, 0, 0}};
  const auto hit = bvh.intersect(ray);
  ASSERT_TRUE(hit);
  const SurfacePoint at = surface_point(bvh.primitives(), ray, *hit, mesh, 0);
  EXPECT_TRUE(at.is_edge_on);
  EXPECT_EQ(at.p, Vec3(3, 1, 0));
  EXPECT_EQ(at.uv(0), Vec2(0.625F, 0.625F));
  EXPECT_EQ(at.color(), Vec4(0, 0.75F, 0.25F, 1));
}

TEST(SurfacePoint, EdgeOnAndOtherRaysAgree) {
  const Scene scene = scene_of_a_triangle();
  const Bvh bvh(scene);
  const auto& mesh = std::get<Mesh>(scene.objects[0].shape);
  const Ray ray{.o = {3, 1, 2}, .d = {0, 0, -1}};
  const auto hit = bvh.intersect(ray);
  ASSERT_TRUE(hit);
  const SurfacePoint at = surface_point(bvh.primitives(), ray, *hit, mesh, 0);
  EXPECT_FALSE(at.is_edge_on);
  EXPECT_EQ(at.uv(0), Vec2(0.625F, 0.625F));
  EXPECT_EQ(at.color(), Vec4(0, 0.75F, 0.25F, 1));
}

}  // namespace
}  // namespace microtrace
