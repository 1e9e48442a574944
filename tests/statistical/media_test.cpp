/// Compares radiance in media with closed-form results. The tolerance is a multiple of the
/// estimate's standard deviation.
#include "render/media/medium.hpp"
#include "support/pictures.hpp"
#include "support/shading/bodies.hpp"
#include "support/shading/h_function.hpp"
#include "support/shading/scattering.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

void expect_mean(const Estimate& got, double expected, double bias = 1e-5) {
  EXPECT_NEAR(got.mean, expected, kFar * got.deviation + bias * expected) << got.deviation;
}

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

// Light that has entered a body with a nearly opaque surface is reflected often before it leaves
// the body. Few paths must not carry all of this light.
TEST(Media, LightLeavesNearlyOpaqueBodies) {
  Material body = scattering(glass_body(Vec3(0.001F), 0.5F), Vec3(1));
  body.transmission->factor = 0.1F;
  const Shot shot{.samples = 64, .max_depth = 256};
  const Estimate light = estimate(ball_under_sky(body), kAcrossBall, shot, kSeeds);
  EXPECT_LT(light.deviation, 0.0016);
  EXPECT_NEAR(light.mean, 1, kFar * light.deviation + 0.01);
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

// The mean free path is far below the spacing of float32 numbers.
TEST(Media, WhiteBodiesOfAnyDensityVanishInTheFurnace) {
  for (const float distance : {1e-6F, 1e-8F, 1e-30F}) {
    for (const float x : {0.0F, 5.0F, 1000.0F}) {
      Scene scene = ball_under_sky(scattering(clear_body(Vec3(0.5F)), Vec3(1)));
      scene.materials[0].volume->attenuation_distance = distance;
      scene.objects[0].shape = Sphere{{x, 0, 0}, 1};
      scene.objects.push_back({.name = "speck", .shape = Sphere{{0, 0, 0}, 0.001F}, .material = 0});
      OrthographicCamera camera = kAcrossBall;
      camera.pose.position.x = x;
      const Estimate light = estimate(scene, camera, {.samples = 4, .max_depth = 512}, kSeeds);
      EXPECT_NEAR(light.mean, 1, kFar * light.deviation + 0.02) << distance << ' ' << x;
      EXPECT_LT(light.mean, 1 + kFar * light.deviation + 0.001) << distance << ' ' << x;
    }
  }
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

// A floor in a scattering medium, beside a large emissive wall. Light sampling finds only the wall
// that is a mesh, and must not change the result.
TEST(Media, LightSamplingInAScatteringMediumIsUnbiased) {
  const auto lit_by = [](const Shape& wall) {
    Scene scene;
    scene.materials = {{.base_color = {0.5F, 0.5F, 0.5F, 1}},
                       scattering(clear_body(Vec3(0.6F, 0.7F, 0.4F)), Vec3(0.8F)),
                       {.base_color = {0, 0, 0, 1}, .emissive = Vec3(1)}};
    scene.objects = {
        {.name = "floor", .shape = Plane{.point = {0, 0, 0}, .normal = {0, 1, 0}}, .material = 0},
        {.name = "surface", .shape = Plane{.point = {0, 2, 0}, .normal = {0, 1, 0}}, .material = 1},
        {.name = "wall", .shape = wall, .material = 2}};
    scene.environment = Environment{.content = Vec3(0)};
    const OrthographicCamera camera{
        .pose = {.position = {0, 3, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 0.01};
    const Shot shot{.size = {.width = 8, .height = 8}, .samples = 512, .max_depth = 4};
    return estimate(scene, camera, shot, kSeeds);
  };
  const Estimate found = lit_by(Plane{.point = {1, 0, 0}, .normal = {-1, 0, 0}});
  const Estimate sampled = lit_by(parallelogram({1, -500, -500}, {0, 0, 1000}, {0, 1000, 0}));
  const double deviation = std::hypot(found.deviation, sampled.deviation);
  EXPECT_GT(found.mean, 0.05);
  EXPECT_LT(deviation, 0.01 * found.mean);
  EXPECT_NEAR(sampled.mean, found.mean, kFar * deviation);
}

}  // namespace
}  // namespace microtrace
