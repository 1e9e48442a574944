/// Compares radiance with closed-form results or quadrature. The tolerance is a multiple of the
/// estimate's standard deviation.
#include "support/pi.hpp"
#include "support/pictures.hpp"
#include "support/shading/scattering.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kRadianceSize{.width = 8, .height = 8};
constexpr std::uint32_t kSeeds = 12;
/// The error of a mean of kSeeds estimates exceeds this multiple of its standard deviation once in
/// 10 000 times (Student's t, 11 degrees of freedom).
constexpr double kFar = 5.8;

void expect_radiance_of(const Estimate& got, double expected) {
  EXPECT_NEAR(got.mean, expected, kFar * got.deviation + 1e-5 * expected) << got.deviation;
}

/// A floor at y = 0. The camera sees a small window of it from straight above.
struct LitFloor {
  explicit LitFloor(const Material& material) {
    scene.materials = {material};
    scene.objects.push_back({.name = "floor",
                             .shape = parallelogram({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}),
                             .material = 0});
    scene.environment = Environment{.content = Vec3(0)};
  }
  Scene scene;
  OrthographicCamera camera{
      .pose = {.position = {0, 1, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 0.001};
};

/// Returns the BSDF of the floor's material toward its camera, multiplied by the cosine.
double scattered(const Material& m, double cosine) {
  const bsdf::Scattering bsdf(
      {.base_color = Vec3(m.base_color), .metallic = m.metallic, .roughness = m.roughness},
      {0, 0, 1});
  return bsdf.evaluate({std::sqrt(1 - cosine * cosine), 0, cosine}).value.y;
}

/// Returns the radiance that the floor reflects straight up, for light that depends only on the
/// zenith angle.
template <class Radiance>
double lit_by(const Material& material, Radiance&& radiance) {
  double sum = 0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;  // uniform in solid angle
    sum += scattered(material, cosine) * radiance(cosine);
  }
  return sum * 2 * kPi / steps;
}

const Material kDiffuse{.base_color = {0.6F, 0.6F, 0.6F, 1}, .roughness = 1};
const Material kShiny{.base_color = {0.9F, 0.9F, 0.9F, 1}, .metallic = 1, .roughness = 0.4F};

/// Returns triangles whose vertices are on the sphere.
Mesh ball(const DVec3& center, double radius) {
  constexpr std::uint32_t rows = 40, columns = 80;
  Mesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double theta = kPi * j / rows, phi = 2 * kPi * i / columns;
      mesh.positions.emplace_back(center + radius * DVec3(std::sin(theta) * std::sin(phi),
                                                          std::cos(theta),
                                                          std::sin(theta) * std::cos(phi)));
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * columns + i, d = j * columns + (i + 1) % columns;
      if (j > 0) mesh.triangles.push_back({a, a + columns, d});
      if (j + 1 < rows) mesh.triangles.push_back({a + columns, d + columns, d});
    }
  }
  return mesh;
}

// A ball is straight above the floor. Its light comes from the cone that is tangent to it.
TEST(Radiance, EmissiveBallOverFloor) {
  const double edge = std::sqrt(1 - 1 / 9.0);
  const Shot shot{.size = kRadianceSize, .samples = 64, .max_depth = 2};
  for (const Material& material : {kDiffuse, kShiny}) {
    const double expected = lit_by(material, [&](double c) { return c > edge ? 5.0 : 0.0; });
    LitFloor floor(material);
    floor.scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = Vec3(5)});
    // Tests the sphere, and then a mesh with the sphere's form.
    floor.scene.objects.push_back({.name = "ball", .shape = Sphere{{0, 3, 0}, 1}, .material = 1});
    expect_radiance_of(estimate(floor.scene, floor.camera, shot, kSeeds), expected);
    floor.scene.objects.back().shape = ball({0, 3, 0}, 1);
    const Estimate mesh = estimate(floor.scene, floor.camera, shot, kSeeds);
    // The mesh lies inside the sphere, by at most 1 - cos(pi / 40).
    EXPECT_NEAR(mesh.mean, expected, kFar * mesh.deviation + 0.008 * expected);
  }
}

// The camera must not see the back of one-sided surfaces. Closed objects must cast the same shadows
// if they are turned inside out.
TEST(Radiance, OneSidedWalls) {
  const double edge = std::sqrt(1 - 1 / 9.0);
  LitFloor floor(kDiffuse);
  floor.scene.environment = Environment{.content = Vec3(1)};
  floor.scene.materials.push_back({.base_color = {0, 0, 0, 1}, .double_sided = false});
  Mesh inside_out = ball({0, 3, 0}, 1);
  for (auto& triangle : inside_out.triangles.edit()) std::swap(triangle[1], triangle[2]);
  floor.scene.objects.push_back({.name = "ball", .shape = inside_out, .material = 1});
  const Shot shot{.size = kRadianceSize, .samples = 64, .max_depth = 2};
  const Estimate shaded = estimate(floor.scene, floor.camera, shot, kSeeds);
  const double expected = lit_by(kDiffuse, [&](double c) { return c > edge ? 0.0 : 1.0; });
  EXPECT_NEAR(shaded.mean, expected, kFar * shaded.deviation + 0.004 * expected);

  // A wall between the floor and the camera, which faces the floor.
  floor.scene.objects.back().shape = parallelogram({-50, 0.5, -50}, {100, 0, 0}, {0, 0, 100});
  floor.scene.materials[0].emissive = Vec3(2);
  const Shot seen{.size = kRadianceSize, .samples = 4, .max_depth = 1};
  EXPECT_NEAR(estimate(floor.scene, floor.camera, seen, 2).mean, 2, 1e-5);
  floor.scene.materials[1].double_sided = true;
  EXPECT_NEAR(estimate(floor.scene, floor.camera, seen, 2).mean, 0, 1e-5);
}

// A map that increases linearly from the horizon to the zenith. It is bilinear between its rows.
TEST(Radiance, EnvironmentOverFloor) {
  constexpr std::uint32_t width = 64, height = 256;
  RadianceMap map{.width = width, .height = height};
  const auto row = [](std::uint32_t y) { return y < height / 2 ? height / 2 - y : 0; };
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) map.pixels.emplace_back(static_cast<float>(row(y)));
  }
  const auto radiance = [&](double cosine) {
    const double v = std::acos(cosine) / kPi * height - 0.5, y = std::floor(v);
    const auto at = [&](double i) {
      return static_cast<double>(row(static_cast<std::uint32_t>(std::max(i, 0.0))));
    };
    return at(y) + (at(y + 1) - at(y)) * (v - y);
  };
  for (const Material& material : {kDiffuse, kShiny}) {
    LitFloor floor(material);
    floor.scene.environment = Environment{.content = std::make_shared<const RadianceMap>(map)};
    expect_radiance_of(
        estimate(floor.scene, floor.camera, {.size = kRadianceSize, .samples = 64}, kSeeds),
        lit_by(material, radiance));
  }
}

// In a closed room of emissive, non-absorbing walls, each path segment contributes as much as the
// first one. Missing light would make the room darker, and light that is counted twice would make
// it brighter.
TEST(Radiance, RoomOfEmissiveWhiteWalls) {
  for (const float metallic : {0.0F, 1.0F}) {
    for (const float roughness : {0.3F, 1.0F}) {
      Scene scene;
      scene.materials = {{.metallic = metallic, .roughness = roughness, .emissive = Vec3(0.5F)}};
      const Vec3 low(-1, -2, -3), x(4, 0, 0), y(0, 3, 0), z(0, 0, 7), high = low + x + y + z;
      for (const Mesh& wall :
           {parallelogram(low, x, y), parallelogram(low, y, z), parallelogram(low, z, x),
            parallelogram(high, -y, -x), parallelogram(high, -z, -y), parallelogram(high, -x, -z)})
        scene.objects.push_back({.name = "wall", .shape = wall, .material = 0});
      scene.environment = Environment{.content = Vec3(1e6F)};  // must not be visible from inside
      const Shot shot{.size = kRadianceSize, .samples = 32, .max_depth = 6};
      const Estimate room = estimate(scene, EnvironmentCamera{}, shot, kSeeds);
      EXPECT_NEAR(room.mean, 3, kFar * room.deviation + 0.01) << metallic << ' ' << roughness;
    }
  }
}

// A quadric is found only by BSDF sampling. Compares an emissive quadric with shapes of the same
// form that have light sampling. Both estimators must agree.
TEST(Radiance, SampledAndUnsampledEmittersAgree) {
  const Shot shot{.size = kRadianceSize, .samples = 64};
  for (const Material& material : {kDiffuse, kShiny}) {
    const auto lit = [&](const Shape& lamp) {
      LitFloor floor(material);
      floor.camera.height = 8;
      floor.camera.pose.position = {0, 9, 0};
      floor.scene.materials.push_back({.base_color = {0.5F, 0.5F, 0.5F, 1}, .emissive = Vec3(2)});
      floor.scene.objects.push_back({.name = "lamp", .shape = lamp, .material = 1});
      return estimate(floor.scene, floor.camera, shot, kSeeds);
    };
    const Estimate met =
        lit(Quadric{.a = 1, .b = 1, .c = 1, .h = -4, .j = 3});  // centered at (0, 2, 0)
    for (const Shape& shape : {Shape{Sphere{{0, 2, 0}, 1}}, Shape{ball({0, 2, 0}, 1)}}) {
      const Estimate sampled = lit(shape);
      EXPECT_NEAR(sampled.mean, met.mean,
                  kFar * std::hypot(sampled.deviation, met.deviation) + 2e-3 * met.mean);
      EXPECT_LT(sampled.deviation, met.deviation);
    }
  }
}

/// An emissive shape above the floor, and the cosine of the zenith angle up to which the shape
/// extends.
struct Lamp {
  Shape shape;
  double cosine;
};

class LampShapes : public testing::TestWithParam<Lamp> {};

// Light sampling makes nearly one sample per pixel sufficient. With BSDF sampling only, the error
// for lights of this size would exceed the mean.
TEST_P(LampShapes, HaveTheExpectedRadiance) {
  for (const Material& material : {kDiffuse, kShiny}) {
    LitFloor floor(material);
    floor.scene.materials.push_back({.double_sided = false, .emissive = Vec3(5)});
    floor.scene.objects.push_back({.name = "lamp", .shape = GetParam().shape, .material = 1});
    const double expected =
        lit_by(material, [](double cosine) { return cosine > GetParam().cosine ? 5.0 : 0.0; });
    const Estimate got = estimate(floor.scene, floor.camera,
                                  {.size = kRadianceSize, .samples = 16, .max_depth = 2}, kSeeds);
    EXPECT_NEAR(got.mean, expected, kFar * got.deviation + 2e-3 * expected) << got.deviation;
    EXPECT_LT(got.deviation * std::sqrt(double{kSeeds} * 16 * 64), 0.5 * expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LampShapes,
                         testing::Values(Lamp{Sphere{{0, 4, 0}, 0.5F}, std::sqrt(1 - 1.0 / 64)},
                                         Lamp{Sphere{{0, 2, 0}, 1.9F}, std::sqrt(1 - 0.95 * 0.95)},
                                         Lamp{Disc{{0, 2, 0}, {0, -3, 0}, 0.5F},
                                              2 / std::sqrt(4.25)}));

// The irradiance of a sphere that is not overhead is pi L (r / d)^2 cos.
TEST(Radiance, ObliqueSphere) {
  const Material material{
      .base_color = {0.5F, 0.5F, 0.5F, 1}, .roughness = 1, .specular = Specular{.factor = 0}};
  LitFloor floor(material);
  floor.scene.materials.push_back({.emissive = Vec3(3)});
  floor.scene.objects.push_back({.name = "lamp", .shape = Sphere{{4, 3, 0}, 1}, .material = 1});
  const double expected = 0.5 * 3 / 25 * 0.6;
  expect_radiance_of(estimate(floor.scene, floor.camera,
                              {.size = kRadianceSize, .samples = 16, .max_depth = 2}, kSeeds),
                     expected);
}

// A single triangle must emit the same light as a mesh of one triangle.
TEST(Radiance, SingleTriangle) {
  const Vec3 a(-1, 2, -1), b(1, 2, -1), c(0.5F, 2.5F, 1);
  std::vector<double> means;
  for (const Shape& shape : {Shape{Triangle{a, b, c}},
                             Shape{Mesh{.positions = {a, b, c}, .triangles = {{{0, 1, 2}}}}}}) {
    LitFloor floor(kDiffuse);
    floor.scene.materials.push_back({.emissive = Vec3(3)});
    floor.scene.objects.push_back({.name = "lamp", .shape = shape, .material = 1});
    means.push_back(mean_of(shoot(floor.scene, floor.camera,
                                  {.size = kRadianceSize, .samples = 16, .max_depth = 2}))
                        .y);
  }
  EXPECT_NEAR(means[0], means[1], 1e-4 * means[1]);
}

// A half-opaque emitter must emit half as much light, both by light sampling and by BSDF sampling.
TEST(Radiance, EmitterWithHalfOpacity) {
  const auto lit = [](float alpha, const Shape& shape) {
    LitFloor floor(kShiny);
    floor.scene.materials.push_back(
        {.base_color = {0, 0, 0, alpha}, .alpha_mode = AlphaMode::blend, .emissive = Vec3(3)});
    floor.scene.objects.push_back({.name = "lamp", .shape = shape, .material = 1});
    return estimate(floor.scene, floor.camera,
                    {.size = kRadianceSize, .samples = 64, .max_depth = 2}, kSeeds);
  };
  for (const Shape& shape : {Shape{parallelogram({-1, 2, -1}, {2, 0, 0}, {0, 0, 2})},
                             Shape{Disc{{0, 2, 0}, {0, 1, 0}, 1}}, Shape{Sphere{{0, 3, 0}, 1}}}) {
    const Estimate whole = lit(1, shape), half = lit(0.5F, shape);
    EXPECT_NEAR(half.mean, whole.mean / 2, kFar * (half.deviation + whole.deviation / 2));
  }
}

}  // namespace
}  // namespace microtrace
