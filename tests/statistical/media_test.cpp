/// Compares radiance in media with closed-form results. The tolerance is a multiple of the
/// estimate's standard deviation.
#include "render/media/medium.hpp"
#include "support/pictures.hpp"
#include "support/shading/h_function.hpp"
#include "support/shading/scattering.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr std::uint32_t kSeeds = 12;
/// The error of a mean of kSeeds estimates exceeds this multiple of its standard deviation once in
/// 10 000 times (Student's t, 11 degrees of freedom).
constexpr double kFar = 5.8;

void expect_mean(const Estimate& got, double expected, double bias = 1e-5) {
  EXPECT_NEAR(got.mean, expected, kFar * got.deviation + bias * expected) << got.deviation;
}

/// A surface that reflects nothing by itself, around a medium that absorbs this color's complement
/// per length 1.
Material boundary(const Vec3& attenuation_color) {
  Material m{.roughness = 0};
  m.specular = Specular{.factor = 0};
  m.volume = Volume{.thickness = 1, .attenuation_distance = 1};
  m.volume->attenuation_color = attenuation_color;
  return m;
}

/// Light enters and leaves the body in all directions.
Material diffuse_body(const Vec3& attenuation_color) {
  Material m = boundary(attenuation_color);
  m.diffuse_transmission = DiffuseTransmission{.factor = 1};
  return m;
}

/// Light crosses the surface without a change of its direction.
Material clear_body(const Vec3& attenuation_color) {
  Material m = boundary(attenuation_color);
  m.ior = 1;
  m.transmission = Transmission{.factor = 1};
  return m;
}

/// A ball of radius 1 in front of a camera that sees only the ball, under uniform white light.
Scene ball_under_sky(const Material& material) {
  Scene scene;
  scene.materials = {material};
  scene.objects.push_back({.name = "ball", .shape = Sphere{{0, 0, 0}, 1}, .material = 0});
  scene.environment = Environment{.content = Vec3(1)};
  return scene;
}
const OrthographicCamera kAcrossBall{
    .pose = {.position = {0, 0, 3}, .direction = {0, 0, -1}, .up = {0, 1, 0}}, .height = 1.4};

// Light that enters a ball with a cosine distribution travels the length s with the pdf s / 2.
TEST(Media, DiffuselyBoundedBallAbsorbs) {
  for (const float color : {1.0F, 0.7F, 0.2F}) {
    const Scene scene = ball_under_sky(diffuse_body(Vec3(color)));
    const double x = -std::log(double{color});
    const double expected = x == 0 ? 1 : (1 - std::exp(-2 * x) * (1 + 2 * x)) / (2 * x * x);
    expect_mean(estimate(scene, kAcrossBall, {.samples = 64, .max_depth = 64}, kSeeds), expected);
  }
}

// A floor lies 2 below the surface of a medium, and a light 1 above the floor.
TEST(Media, LightWithinAMediumIsAbsorbed) {
  Scene scene;
  scene.materials = {{.base_color = {0.5F, 0.5F, 0.5F, 1}}, clear_body(Vec3(0.6F))};
  scene.objects.push_back({.name = "floor",
                           .shape = parallelogram({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}),
                           .material = 0});
  scene.objects.push_back(
      {.name = "surface", .shape = Plane{.point = {0, 2, 0}, .normal = {0, 1, 0}}, .material = 1});
  scene.environment = Environment{.content = Vec3(0)};
  const OrthographicCamera camera{
      .pose = {.position = {0, 3, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 0.01};
  const Shot shot{.size = {.width = 8, .height = 8}, .samples = 64, .max_depth = 3};
  const bsdf::Scattering floor({.base_color = Vec3(0.5F)}, {0, 0, 1});
  const auto reflected = [&](double cosine) {
    return floor.evaluate({std::sqrt(1 - cosine * cosine), 0, cosine}).value.y;
  };
  scene.lights.push_back({.name = "lamp", .light = PointLight{.position = {0, 1, 0}}});
  // A surface whose index of refraction is 1 is computed with 1.003.
  expect_mean(estimate(scene, camera, shot, kSeeds), reflected(1) * std::pow(0.6, 3), 0.003);

  // A disc of radius 1, of which both light sampling and BSDF sampling find some.
  scene.lights.clear();
  scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = Vec3(1)});
  scene.objects.push_back({.name = "disc",
                           .shape = Disc{.center = {3, 1, 0}, .normal = {0, -1, 0}, .radius = 1},
                           .material = 2});
  double expected = 0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double r = std::sqrt((i + 0.5) / steps);
      const double phi = 2 * std::numbers::pi * (j + 0.5) / steps;
      const double x = 3 + r * std::cos(phi), z = r * std::sin(phi);
      const double distance = std::sqrt(x * x + z * z + 1), cosine = 1 / distance;
      expected += reflected(cosine) * std::pow(0.6, 2 + distance) * cosine / (distance * distance);
    }
  }
  expected *= std::numbers::pi / steps / steps;
  Shot more = shot;
  more.samples = 256;
  expect_mean(estimate(scene, camera, more, kSeeds), expected, 0.003);
}

Material scattering(Material body, const Vec3& color, float anisotropy = 0) {
  body.volume_scatter = VolumeScatter{.multiscatter_color = color, .anisotropy = anisotropy};
  return body;
}

/// Light is refracted at the surface.
Material glass_body(const Vec3& attenuation_color, float roughness) {
  Material m{.roughness = roughness};
  m.transmission = Transmission{.factor = 1};
  m.volume = clear_body(attenuation_color).volume;
  return m;
}

// A body that absorbs no light must be as bright as the light around it.
TEST(Media, WhiteBodiesVanishInTheFurnace) {
  struct Case {
    const char* name;
    Material body;
    double loss;  ///< by the surface, see docs/light.md
  };
  const Vec3 half(0.5F), dense(1e-6F), mixed(0.9F, 0.5F, 0.01F);
  for (const Case& c : {
           Case{"clear", scattering(clear_body(half), Vec3(1)), 0.001},
           Case{"clear, dense", scattering(clear_body(dense), Vec3(1)), 0.001},
           Case{"clear, forward", scattering(clear_body(dense), Vec3(1), 0.8F), 0.001},
           Case{"clear, back", scattering(clear_body(mixed), Vec3(1), -0.5F), 0.001},
           Case{"diffuse", scattering(diffuse_body(dense), Vec3(1)), 0.001},
           Case{"diffuse, mixed", scattering(diffuse_body(mixed), Vec3(1), 0.3F), 0.001},
           Case{"glass", scattering(glass_body(half, 0), Vec3(1)), 0.01},
           Case{"rough glass", scattering(glass_body(dense, 0.5F), Vec3(1)), 0.02},
       }) {
    const Estimate light =
        estimate(ball_under_sky(c.body), kAcrossBall, {.samples = 16, .max_depth = 512}, kSeeds);
    EXPECT_NEAR(light.mean, 1, kFar * light.deviation + c.loss) << c.name;
    EXPECT_LT(light.mean, 1 + kFar * light.deviation + 0.001) << c.name;
  }
}

// A ball where float32 numbers are as far apart as the mean distance between scattering events. The
// speck at the origin keeps the scene from being translated there.
TEST(Media, WhiteBodyFarAwayVanishesInTheFurnace) {
  Scene scene = ball_under_sky(scattering(clear_body(Vec3(0.5F)), Vec3(1)));
  scene.materials[0].volume->attenuation_distance = 0.0005F;
  scene.objects[0].shape = Sphere{{4096, 0, 0}, 1};
  scene.objects.push_back({.name = "speck", .shape = Sphere{{0, 0, 0}, 0.001F}, .material = 0});
  OrthographicCamera camera = kAcrossBall;
  camera.pose.position.x = 4096;
  const Estimate light = estimate(scene, camera, {.samples = 4, .max_depth = 512}, kSeeds);
  EXPECT_NEAR(light.mean, 1, kFar * light.deviation + 0.02) << "some paths end after 4096 events";
  EXPECT_LT(light.mean, 1 + kFar * light.deviation + 0.001);
}

// A medium below a plane, seen from straight above under a white sky.
TEST(Media, HalfSpaceReflectsAsPublished) {
  Scene scene = ball_under_sky({});
  scene.objects[0].shape = Plane{.point = {0, 0, 0}, .normal = {0, 0, 1}};
  for (const float color : {0.1F, 0.5F, 0.9F}) {
    scene.materials[0] = scattering(clear_body(Vec3(0.3F)), Vec3(color));
    const HFunction h(single_scattering_albedo(color));
    expect_mean(estimate(scene, kAcrossBall, {.samples = 16, .max_depth = 512}, kSeeds),
                h.reflected(1), 0.001);
  }
}

// Light that enters a dense ball in all directions leaves it with the color of a half-space.
TEST(Media, DenseBallHasTheColorOfItsMaterial) {
  const Vec3 color(0.2F, 0.6F, 0.9F);
  Scene scene = ball_under_sky(scattering(diffuse_body(Vec3(0.5F)), color));
  scene.materials[0].volume->attenuation_distance = 0.001F;
  DVec3 mean(0);
  for (std::uint32_t seed = 0; seed < 4; ++seed)
    mean +=
        mean_of(shoot(scene, kAcrossBall, {.samples = 64, .seed = seed, .max_depth = 64})) / 4.0;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], color[c], 0.01) << c;
}

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
  /// The radiance that arrives without reflection at a boundary.
  [[nodiscard]] double seen(std::uint32_t boundaries) const {
    const OrthographicCamera camera{
        .pose = {.position = {0, 9, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 0.01};
    return mean_of(shoot(scene, camera, {.samples = 512, .max_depth = boundaries + 1})).y;
  }
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
TEST(Media, NestedBodiesRestoreTheOuterMedium) {
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
TEST(Media, OverlappingBodiesHaveOneBoundary) {
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

// Two bodies of the same glass that overlap are one body.
TEST(Media, OverlappingBodiesOfOneMediumAreOne) {
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
TEST(Media, BodyOfTheSameMediumIsInvisible) {
  Scene scene = ball_under_sky(glass_body(Vec3(0.5F), 0));
  const Estimate alone = estimate(scene, kAcrossBall, {.samples = 64, .max_depth = 64}, kSeeds);
  scene.objects.push_back({.name = "inner", .shape = Sphere{{0.2F, 0, 0}, 0.5F}, .material = 0});
  const Estimate both = estimate(scene, kAcrossBall, {.samples = 64, .max_depth = 64}, kSeeds);
  EXPECT_NEAR(both.mean, alone.mean, kFar * (alone.deviation + both.deviation) + 0.005);
}

// White media within each other, also with a scattering one, lose no light.
TEST(Media, NestedBodiesVanishInTheFurnace) {
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
