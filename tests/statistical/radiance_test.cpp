/// Radiance that closed forms or quadrature tell, within the deviation of the estimates.
#include "render/bsdf/bsdf.hpp"
#include "support/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr ImageSize kSize{.width = 8, .height = 8};
constexpr std::uint32_t kSeeds = 12;
/// A mean of kSeeds is further off once in 10 000 times (Student's t, 11 degrees of freedom).
constexpr double kFar = 5.8;

void expect_mean(const Estimate& got, double expected) {
  EXPECT_NEAR(got.mean, expected, kFar * got.deviation + 1e-5 * expected) << got.deviation;
}

/// A floor at y = 0, seen from straight above in a small window.
struct Floor {
  explicit Floor(const Material& material) {
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

/// f |cos| of the floor's material towards its camera.
double scattered(const Material& m, double cosine) {
  const bsdf::Bsdf bsdf(
      {.base_color = Vec3(m.base_color), .metallic = m.metallic, .roughness = m.roughness},
      {0, 0, 1});
  return bsdf.evaluate({std::sqrt(1 - cosine * cosine), 0, cosine}).value.y;
}

/// What the floor sends up under light that depends on the angle from the zenith alone.
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

const Material kMatt{.base_color = {0.6F, 0.6F, 0.6F, 1}, .roughness = 1};
const Material kShiny{.base_color = {0.9F, 0.9F, 0.9F, 1}, .metallic = 1, .roughness = 0.4F};

/// Of triangles whose corners lie on the sphere.
Mesh ball(const DVec3& centre, double radius) {
  constexpr std::uint32_t rows = 40, columns = 80;
  Mesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double theta = kPi * j / rows, phi = 2 * kPi * i / columns;
      mesh.positions.emplace_back(centre + radius * DVec3(std::sin(theta) * std::sin(phi),
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

// Straight above: the light within the cone that touches the ball.
TEST(Radiance, ShiningBallOverFloor) {
  const double edge = std::sqrt(1 - 1 / 9.0);
  const Shot shot{.size = kSize, .samples = 64, .max_depth = 2};
  for (const Material& material : {kMatt, kShiny}) {
    const double expected = lit_by(material, [&](double c) { return c > edge ? 5.0 : 0.0; });
    Floor floor(material);
    floor.scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = Vec3(5)});
    // The sphere's own shape is met by paths alone, its mesh is sampled too.
    floor.scene.objects.push_back({.name = "ball", .shape = Sphere{{0, 3, 0}, 1}, .material = 1});
    expect_mean(estimate(floor.scene, floor.camera, shot, kSeeds), expected);
    floor.scene.objects.back().shape = ball({0, 3, 0}, 1);
    const Estimate mesh = estimate(floor.scene, floor.camera, shot, kSeeds);
    // The mesh lies within the sphere, by up to 1 - cos(pi / 40).
    EXPECT_NEAR(mesh.mean, expected, kFar * mesh.deviation + 0.008 * expected);
  }
}

// A map that grows linearly from the horizon to the zenith; bilinear between its rows.
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
  for (const Material& material : {kMatt, kShiny}) {
    Floor floor(material);
    floor.scene.environment = Environment{.content = std::make_shared<const RadianceMap>(map)};
    expect_mean(estimate(floor.scene, floor.camera, {.size = kSize, .samples = 64}, kSeeds),
                lit_by(material, radiance));
  }
}

// In a closed room whose walls all shine and absorb nothing, each straight part of a path brings as
// much as the first. Unseen corners would make it darker, lights counted twice brighter.
TEST(Radiance, RoomOfShiningWhiteWalls) {
  for (const float metallic : {0.0F, 1.0F}) {
    for (const float roughness : {0.3F, 1.0F}) {
      Scene scene;
      scene.materials = {{.metallic = metallic, .roughness = roughness, .emissive = Vec3(0.5F)}};
      const Vec3 low(-1, -2, -3), x(4, 0, 0), y(0, 3, 0), z(0, 0, 7), high = low + x + y + z;
      for (const Mesh& wall :
           {parallelogram(low, x, y), parallelogram(low, y, z), parallelogram(low, z, x),
            parallelogram(high, -y, -x), parallelogram(high, -z, -y), parallelogram(high, -x, -z)})
        scene.objects.push_back({.name = "wall", .shape = wall, .material = 0});
      scene.environment = Environment{.content = Vec3(1e6F)};  // must not come in
      const Shot shot{.size = kSize, .samples = 32, .max_depth = 6};
      const Estimate room = estimate(scene, EnvironmentCamera{}, shot, kSeeds);
      EXPECT_NEAR(room.mean, 3, kFar * room.deviation + 0.01) << metallic << ' ' << roughness;
    }
  }
}

// The same lamp as a mesh, which is sampled, and as triangles of their own, which paths must meet:
// light sampling with its weights against the material's samples alone.
TEST(Radiance, LampsThatAreSampledAndLampsThatAreMet) {
  const Shot shot{.size = kSize, .samples = 64};
  for (const Material& material : {kMatt, kShiny}) {
    Floor sampled(material);
    sampled.camera.height = 8;
    sampled.camera.pose.position = {0, 9, 0};
    sampled.scene.materials.push_back({.base_color = {0.5F, 0.5F, 0.5F, 1}, .emissive = Vec3(2)});
    Floor met = sampled;
    const Vec3 corner(-1, 1, -2), along(2, 0.5F, 0), up(0, 0.3F, 3), top = corner + along + up;
    sampled.scene.objects.push_back(
        {.name = "lamp", .shape = parallelogram(corner, along, up), .material = 1});
    met.scene.objects.push_back(
        {.name = "a", .shape = Triangle{corner, corner + along, top}, .material = 1});
    met.scene.objects.push_back(
        {.name = "b", .shape = Triangle{corner, top, corner + up}, .material = 1});
    const Estimate a = estimate(sampled.scene, sampled.camera, shot, kSeeds);
    const Estimate b = estimate(met.scene, met.camera, shot, kSeeds);
    EXPECT_NEAR(a.mean, b.mean, kFar * std::hypot(a.deviation, b.deviation));
    EXPECT_LT(a.deviation, b.deviation);
  }
}

}  // namespace
}  // namespace microtrace
