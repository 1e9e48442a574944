/// Compares the radiance of bodies that lie within each other or overlap with closed-form results.
#include "support/pi.hpp"
#include "support/pictures.hpp"
#include "support/shading/bodies.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Horizontal boundaries of media, above an emissive black floor at y = 0. The camera looks
/// straight down from y = 9.
struct Layers {
  Layers() {
    scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = Vec3(1)});
    scene.materials[0].specular = Specular{.factor = 0};
    add(0, true, 0);
    scene.environment = Environment{.content = Vec3(0)};
  }
  /// Adds a boundary whose medium is below it if `faces_up`, otherwise above it.
  void add(float y, bool faces_up, std::uint32_t material) {
    scene.objects.push_back(
        {.name = "boundary",
         .shape = Plane{.point = {0, y, 0}, .normal = {0, faces_up ? 1.0F : -1.0F, 0}},
         .material = material});
  }
  /// The radiance that arrives after this number of boundaries, at most.
  [[nodiscard]] DVec3 color(std::uint32_t boundaries) const {
    const OrthographicCamera camera{
        .pose = {.position = {0, 9, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 0.01};
    return mean_of(shoot(scene, camera, {.samples = 512, .max_depth = boundaries + 1}));
  }
  [[nodiscard]] double seen(std::uint32_t boundaries) const { return color(boundaries).y; }
  Scene scene;
};

/// A clear medium without a rough surface.
Material medium(float ior, float left) {
  Material m = glass_body(Vec3(left), 0);
  m.ior = ior;
  return m;
}

double transmitted(double ior_above, double ior_below) {
  const double r = (ior_above - ior_below) / (ior_above + ior_below);
  return 1 - r * r;
}

// Ice in water in glass, of which each body lies wholly inside the next. On the way out, the medium
// of the outer body must be present again.
TEST(NestedMedia, NestedBodiesRestoreTheOuterMedium) {
  Layers layers;
  for (const Material& m : {medium(1.5F, 0.9F), medium(1.33F, 0.8F), medium(1.31F, 0.7F)})
    layers.scene.materials.push_back(m);
  layers.add(7, true, 1);  // glass from 7 to 1
  layers.add(6, true, 2);  // water from 6 to 2
  layers.add(5, true, 3);  // ice from 5 to 3
  layers.add(3, false, 3);
  layers.add(2, false, 2);
  layers.add(1, false, 1);
  const double glass_water = transmitted(1.5, 1.33), water_ice = transmitted(1.33, 1.31);
  const double expected = std::pow(transmitted(1, 1.5) * glass_water * water_ice, 2) *
                          std::pow(0.9, 2) * std::pow(0.8, 2) * std::pow(0.7, 2);
  EXPECT_NEAR(layers.seen(6), expected, 0.006 * expected);
}

// Water that reaches into the wall of its glass. Light from above meets the water's surface inside
// the glass, and then doesn't notice the end of the glass.
TEST(NestedMedia, OverlappingBodiesHaveOneBoundary) {
  Layers layers;
  for (const Material& m : {medium(1.5F, 0.9F), medium(1.33F, 0.8F)})
    layers.scene.materials.push_back(m);
  layers.add(6, true, 1);  // glass from 6 to 4
  layers.add(4, false, 1);
  layers.add(4.5F, true, 2);  // water from 4.5 to 0
  const double expected =
      transmitted(1, 1.5) * transmitted(1.5, 1.33) * std::pow(0.9, 1.5) * std::pow(0.8, 4.5);
  EXPECT_NEAR(layers.seen(2), expected, 0.006 * expected);
}

// The floor lies in water that reaches through the side of its glass, the lamp beyond that side.
// Neither paths nor shadow rays notice the glass's end inside the water.
TEST(NestedMedia, HiddenBoundariesLetShadowRaysPass) {
  Layers layers;
  for (const Material& m : {medium(1.5F, 1), medium(1.33F, 0.9F)})
    layers.scene.materials.push_back(m);
  layers.scene.materials[0] = {
      .base_color = Vec4(0.5F), .metallic = 0, .specular = Specular{.factor = 0}};
  layers.add(6, true, 1);
  layers.scene.objects.push_back(
      {.name = "side", .shape = Plane{.point = {1, 0, 0}, .normal = {1, 0, 0}}, .material = 1});
  layers.add(5, true, 2);
  layers.scene.lights.push_back(
      {.name = "lamp", .light = PointLight{.position = {2, 2, 0}, .intensity = 100}});
  const double distance = std::sqrt(8);
  const double expected = transmitted(1, 1.5) * transmitted(1.5, 1.33) *
                          std::pow(0.9, 5 + distance) * 0.5 / kPi * 100 * std::sqrt(0.5) / 8;
  EXPECT_NEAR(layers.seen(3), expected, 0.01 * expected);
}

// A facet of dispersive glass inside a denser glass, tilted by 53 degrees. By Snell's law, only red
// is totally reflected, to an emissive wall. Green and blue reach the floor, which is black.
TEST(NestedMedia, TotalReflectionDependsOnTheColor) {
  Layers layers;
  layers.scene.materials.push_back(layers.scene.materials[0]);
  layers.scene.materials[0].emissive = Vec3(0);
  layers.scene.objects.push_back(
      {.name = "wall", .shape = Plane{.point = {4, 0, 0}, .normal = {-1, 0, 0}}, .material = 1});
  for (Material m : {medium(1.8F, 1), medium(1.5F, 1)}) {
    m.specular = Specular{.factor = 0};
    layers.scene.materials.push_back(m);
  }
  layers.scene.materials[3].dispersion = 10;
  layers.add(7, true, 2);
  const double tilt = 53 * kPi / 180;
  layers.scene.objects.push_back(
      {.name = "facet",
       .shape = Plane{.point = {0, 5, 0}, .normal = Vec3(std::sin(tilt), std::cos(tilt), 0)},
       .material = 3});
  const DVec3 seen = layers.color(2);
  for (int c = 0; c < 3; ++c) {
    const double ior = 1.5 + (c - 1) * (1.5 - 1) * 0.025 * 10;
    const bool is_total = 1.8 * std::sin(tilt) > ior;
    EXPECT_EQ(is_total, c == 0);
    EXPECT_NEAR(seen[c], is_total ? 1 : 0, 0.006) << c;
  }
}

// Dispersive glass in a denser glass, with total reflection at grazing angles, loses no light in
// any color.
TEST(NestedMedia, DispersiveBodyVanishesInTheFurnace) {
  Scene scene = ball_under_sky(medium(1.8F, 1));
  scene.materials.push_back(medium(1.5F, 1));
  scene.materials[1].dispersion = 10;
  scene.objects.push_back({.name = "inner", .shape = Sphere{{0, 0, 0}, 0.6F}, .material = 1});
  OrthographicCamera camera = kAcrossBall;
  camera.height = 1.35F;
  const DVec3 light = mean_of(shoot(
      scene, camera, {.size = {.width = 32, .height = 32}, .samples = 256, .max_depth = 128}));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], 1, 0.01) << c;
}

// Two bodies of the same glass that overlap are one body.
TEST(NestedMedia, OverlappingBodiesOfOneMediumAreOne) {
  Layers layers;
  layers.scene.materials.push_back(medium(1.5F, 0.8F));
  layers.add(6, true, 1);
  layers.add(5, true, 1);
  layers.add(4, false, 1);
  layers.add(2, false, 1);
  const double expected = std::pow(transmitted(1, 1.5), 2) * std::pow(0.8, 4);
  EXPECT_NEAR(layers.seen(4), expected, 0.006 * expected);
}

// A ball of glass in a larger ball of the same glass can't be seen.
TEST(NestedMedia, BodyOfTheSameMediumIsInvisible) {
  Scene scene = ball_under_sky(glass_body(Vec3(0.5F), 0));
  const Estimate alone = estimate(scene, kAcrossBall, {.samples = 64, .max_depth = 64}, kSeeds);
  scene.objects.push_back({.name = "inner", .shape = Sphere{{0.2F, 0, 0}, 0.5F}, .material = 0});
  const Estimate both = estimate(scene, kAcrossBall, {.samples = 64, .max_depth = 64}, kSeeds);
  EXPECT_NEAR(both.mean, alone.mean, kFar * (alone.deviation + both.deviation) + 0.005);
}

// White media within each other, also with a scattering one, lose no light.
TEST(NestedMedia, NestedBodiesVanishInTheFurnace) {
  Scene scene = ball_under_sky(medium(1.5F, 1));
  const auto add = [&](const Material& m, float radius) {
    const auto index = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(m);
    scene.objects.push_back(
        {.name = "inner", .shape = Sphere{{0.1F, 0, 0}, radius}, .material = index});
  };
  add(scattering(medium(1.33F, 0.1F), Vec3(1)), 0.8F);
  add(medium(1, 1), 0.5F);  // a bubble
  add(scattering(diffuse_body(Vec3(0.1F)), Vec3(1)), 0.2F);
  const Estimate light = estimate(scene, kAcrossBall, {.samples = 16, .max_depth = 512}, kSeeds);
  EXPECT_NEAR(light.mean, 1, kFar * light.deviation + 0.02);
  EXPECT_LT(light.mean, 1 + kFar * light.deviation + 0.001);
}

}  // namespace
}  // namespace microtrace
