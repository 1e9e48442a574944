/// Tests changes that must not affect path-traced pictures.
#include "support/cases/closed_meshes.hpp"
#include "support/effort.hpp"
#include "support/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

// Inside a closed surface, outside light must never be visible, however thin and creased the
// surface is and wherever it is. The materials don't absorb light, so any leak would remain
// visible.
TEST(Invariance, ClosedSurfacesLetNoLightIn) {
  const auto effort = std::max(std::uint32_t(traversal::ray_count(1e-6)), 1U);
  for (const auto& closed : adversarial::closed_meshes()) {
    Scene scene;
    scene.materials = {{.metallic = 0.5F, .roughness = 0.5F}};
    scene.objects.push_back({.name = "box", .shape = closed.mesh, .material = 0});
    scene.environment = Environment{.content = Vec3(1e9F), .is_background = true};
    scene.lights.push_back(
        {.name = "lamp",
         .light = PointLight{.position = DVec3(closed.center) + DVec3(0, 64 * closed.radius, 0),
                             .intensity = 1e20F}});
    const EnvironmentCamera camera{.pose = {.position = DVec3(closed.center)}};
    const Film film =
        shoot(scene, camera,
              {.size = {.width = 32, .height = 16}, .samples = 32 * effort, .max_depth = 12});
    for (const DVec3& pixel : pixels_of(film)) ASSERT_EQ(pixel, DVec3(0)) << closed.name;
  }
}

/// Returns a square in the plane y = 0 with edges of length 64. Its 2 n^2 triangles have vertices
/// on a grid.
Mesh tiled_floor(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i)
      mesh.positions.emplace_back(64.0F * float(i) / float(n) - 32, 0,
                                  64.0F * float(j) / float(n) - 32);
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

// Under grazing light, a floor of many triangles must look like a floor of two triangles. No
// triangle may shadow its neighbors.
TEST(Invariance, FlatTrianglesCastNoShadows) {
  Scene scene;
  scene.materials = {{.base_color = {0.8F, 0.8F, 0.8F, 1}, .metallic = 0.5F, .roughness = 0.6F}};
  scene.objects.push_back({.name = "floor", .shape = tiled_floor(1), .material = 0});
  scene.environment = Environment{.content = Vec3(0.1F)};
  scene.lights.push_back(
      {.name = "sun",
       .light =
           DirectionalLight{.direction = glm::normalize(DVec3(1, -1e-4, 0.3)), .intensity = 1e4F}});
  scene.lights.push_back(
      {.name = "lamp", .light = PointLight{.position = {9, 0.001, 2}, .intensity = 1000}});
  const PerspectiveCamera camera{
      .pose = {.position = {0, 3, 8}, .direction = {0, -1, -1}, .up = {0, 1, 0}}};
  const Shot shot{.size = {.width = 64, .height = 48}, .samples = 8};
  const auto coarse = pixels_of(shoot(scene, camera, shot));
  scene.objects[0].shape = tiled_floor(256);
  const auto fine = pixels_of(shoot(scene, camera, shot));
  for (std::size_t i = 0; i < fine.size(); ++i) {
    ASSERT_GT(coarse[i].y, 0);
    ASSERT_NEAR(fine[i].y, coarse[i].y, 2e-3 * coarse[i].y) << i % 64 << ' ' << i / 64;
  }
}

/// Returns a specular and a diffuse block on a floor under an area light. All vertices are on a
/// grid of 1/8.
Scene blocks(const Vec3& shift) {
  Scene scene;
  scene.materials = {{.base_color = {0.7F, 0.6F, 0.5F, 1}},
                     {.base_color = {0.9F, 0.9F, 0.9F, 1}, .metallic = 1, .roughness = 0.4F},
                     {.base_color = {0, 0, 0, 1}, .emissive = Vec3(20)}};
  const auto add = [&](const Vec3& corner, const Vec3& along, const Vec3& up, std::uint32_t m) {
    scene.objects.push_back(
        {.name = "part", .shape = parallelogram(corner + shift, along, up), .material = m});
  };
  add({-32, 0, 32}, {64, 0, 0}, {0, 0, -64}, 0);
  add({-4, 20, -4}, {0, 0, 8}, {8, 0, 0}, 2);
  for (const float x : {-9.0F, 1.0F}) {
    const std::uint32_t m = x > 0 ? 1 : 0;
    add({x, 0, 4}, {8, 0, 0}, {0, 6, 0.5F}, m);
    add({x, 6, 4.5F}, {8, 0, 0}, {0, 0, -8}, m);
    add({x + 8, 0, 4}, {0, 0, -8}, {0, 6, 0.5F}, m);
    add({x, 0, -4}, {0, 0, 8}, {0, 6, 0.5F}, m);
  }
  scene.environment = Environment{.content = Vec3(0.25F)};
  return scene;
}

// Translates the scene far from the origin without changing offsets in float32. The picture must be
// as precise as near the origin.
TEST(Invariance, FarFromTheOriginPicturesAreEqual) {
  const Vec3 shift(0x1p20F, -0x1p19F, 0x1p20F);
  const Shot shot{.size = {.width = 64, .height = 48}, .samples = 16};
  const auto picture = [&](const Vec3& by) {
    const PerspectiveCamera camera{.pose = {.position = DVec3(by) + DVec3(6, 14, 32),
                                            .direction = {-6, -11, -32},
                                            .up = {0, 1, 0}}};
    return pixels_of(shoot(blocks(by), camera, shot));
  };
  const auto here = picture(Vec3(0)), there = picture(shift);
  double difference = 0, light = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    difference += std::abs(here[i].y - there[i].y);
    light += here[i].y;
  }
  EXPECT_LT(difference / light, 1e-5);
}

// The AOVs of a path-traced picture must refer to the original coordinates.
TEST(Invariance, FarFromTheOriginExactQuantitiesAreUnchanged) {
  const Vec3 shift(0x1p20F, -0x1p19F, 0x1p20F);
  const Scene scene = blocks(shift);
  const PerspectiveCamera camera{.pose = {.position = DVec3(shift) + DVec3(6, 14, 32),
                                          .direction = {-6, -11, -32},
                                          .up = {0, 1, 0}}};
  const ImageSize size{.width = 32, .height = 24};
  const PathIntegrator path;
  RenderOptions options{.integrator = &path, .samples = 1};
  options.aovs = {Aov::position, Aov::id};
  options.sampled_aovs = {SampledAov::variance};
  const Film lit = render(scene, camera, size, options);
  options.integrator = nullptr;
  options.sampled_aovs.clear();
  const Film flat = render(scene, camera, size, options);
  ASSERT_EQ(lit.channels.size(), flat.channels.size() + 1);
  for (std::size_t i = 0; i < flat.channels.size(); ++i) {
    EXPECT_EQ(lit.channels[i].name, flat.channels[i].name);
    EXPECT_EQ(lit.channels[i].values, flat.channels[i].values);
  }
}

// After an integrator has rendered a lit scene, it must render a scene without lights correctly.
TEST(Invariance, ScenesWithoutLightsAreBlackAfterOthers) {
  Scene lit = blocks(Vec3(0)), unlit = lit;
  lit.lights.push_back(
      {.name = "lamp", .light = PointLight{.position = {0, 15, 9}, .intensity = 500}});
  unlit.materials[2].emissive = Vec3(0);
  const PerspectiveCamera camera{
      .pose = {.position = {6, 14, 32}, .direction = {-6, -11, -32}, .up = {0, 1, 0}}};
  const ImageSize size{.width = 32, .height = 24};
  const PathIntegrator used, fresh;
  const auto pixels = [&](const Scene& scene, const PathIntegrator& path) {
    return pixels_of(
        render(scene, camera, size, {.threads = 1, .integrator = &path, .samples = 4}));
  };
  ASSERT_NE(pixels(lit, used), pixels(unlit, fresh));
  EXPECT_EQ(pixels(unlit, used), pixels(unlit, fresh));
}

// Pictures with area lights, a map, blending, and smooth and rough surfaces must not depend on the
// number of threads or on the crop window.
TEST(Invariance, ThreadsAndCropsKeepAllBytes) {
  Scene scene = blocks(Vec3(0));
  RadianceMap map{.width = 8, .height = 4};
  for (int i = 0; i < 32; ++i) map.pixels.emplace_back(i == 11 ? 30.0F : 0.3F);
  scene.environment = Environment{.content = std::make_shared<const RadianceMap>(map)};
  scene.materials[1].base_color.a = 0.5F;
  scene.materials[1].alpha_mode = AlphaMode::blend;
  scene.lights.push_back(
      {.name = "spot", .light = SpotLight{.position = {3, 9, 9}, .direction = {0, -1, 0}}});
  const PerspectiveCamera camera{
      .pose = {.position = {6, 14, 32}, .direction = {-6, -11, -32}, .up = {0, 1, 0}}};
  const PathIntegrator path;
  RenderOptions options{.threads = 1, .integrator = &path, .samples = 5, .seed = 3};
  const ImageSize size{.width = 71, .height = 37};
  const Film one = render(scene, camera, size, options);
  for (const unsigned threads : {2U, 3U, 8U}) {
    options.threads = threads;
    options.crop = PixelRect{.x0 = threads, .y0 = 3, .x1 = 71 - threads, .y1 = 30 + threads % 8};
    Film part = render(scene, camera, size, options);
    for (std::uint32_t y = 3; y < options.crop->y1; ++y) {
      for (std::uint32_t x = threads; x < 71 - threads; ++x)
        ASSERT_EQ(part.at(x - threads, y - 3), one.row(y)[x]) << threads;
    }
  }
}

}  // namespace
}  // namespace microtrace
