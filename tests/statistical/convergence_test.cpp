/// Tests the rate of convergence, and that pictures with few samples are unbiased.
#include "support/effort.hpp"
#include "support/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns a scene of diffuse and specular objects on a floor under an area light and a sky.
Scene still_life() {
  Scene scene;
  scene.materials = {
      {.base_color = {0.7F, 0.7F, 0.7F, 1}},
      {.base_color = {0.9F, 0.7F, 0.3F, 1}, .metallic = 1, .roughness = 0.5F},
      {.base_color = {0, 0, 0, 1}, .emissive = Vec3(8)},
      {.base_color = {0.2F, 0.5F, 0.9F, 0.6F}, .alpha_mode = AlphaMode::blend, .roughness = 0.7F}};
  scene.objects.push_back({.name = "floor", .shape = Plane{{0, 0, 0}, {0, 1, 0}}, .material = 0});
  scene.objects.push_back({.name = "matt", .shape = Sphere{{-1.1F, 1, 0}, 1}, .material = 0});
  scene.objects.push_back({.name = "gold", .shape = Sphere{{1.1F, 1, 0}, 1}, .material = 1});
  scene.objects.push_back(
      {.name = "lamp", .shape = parallelogram({-1, 4, -1}, {2, 0, 0}, {0, 0, 2}), .material = 2});
  scene.objects.push_back(
      {.name = "pane", .shape = parallelogram({-2, 0, 1.5F}, {2, 0, 0}, {0, 1, 0}), .material = 3});
  RadianceMap map{.width = 16, .height = 8};
  for (int i = 0; i < 128; ++i) map.pixels.emplace_back(i < 64 ? 0.4F + 0.1F * float(i % 5) : 0.1F);
  scene.environment = Environment{.content = std::make_shared<const RadianceMap>(map)};
  return scene;
}

const PerspectiveCamera kCamera{
    .pose = {.position = {0, 2, 6}, .direction = {0, -0.2, -1}, .up = {0, 1, 0}}};

double error(const std::vector<DVec3>& a, const std::vector<DVec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i].y - b[i].y) * (a[i].y - b[i].y);
  return std::sqrt(sum / double(a.size()));
}

/// Returns the slope of log(error) over log(samples). The error is relative to a reference picture
/// with many samples.
double slope(const Scene& scene, const Camera& camera, Shot shot, std::uint32_t most) {
  Shot reference = shot;
  reference.samples = 8 * most;
  reference.seed = 99;
  const auto right = pixels_of(shoot(scene, camera, reference));
  double x = 0, y = 0, xx = 0, xy = 0, n = 0;
  for (std::uint32_t samples = 4; samples <= most; samples *= 2) {
    shot.samples = samples;
    const double a = std::log2(double(samples));
    const double b = std::log2(error(pixels_of(shoot(scene, camera, shot)), right));
    x += a, y += b, xx += a * a, xy += a * b, ++n;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

// If an area light has no visible edges, its direct light is a smooth function of the point on the
// light.
TEST(Convergence, SmoothLightConvergesAtTheSobolRate) {
  Scene scene;
  scene.materials = {{.base_color = {0.7F, 0.7F, 0.7F, 1}},
                     {.base_color = {0, 0, 0, 1}, .emissive = Vec3(8)}};
  scene.objects.push_back({.name = "floor", .shape = Plane{{0, 0, 0}, {0, 1, 0}}, .material = 0});
  scene.objects.push_back(
      {.name = "lamp",
       .shape = Mesh{.positions = {{-1, 4, -1}, {1, 4, -1}, {0, 4, 2}}, .triangles = {{{0, 1, 2}}}},
       .material = 1});
  scene.environment = Environment{.content = Vec3(0)};
  const OrthographicCamera camera{
      .pose = {.position = {0, 1, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 1};
  const Shot shot{.size = {.width = 8, .height = 8}, .max_depth = 2};
  EXPECT_LT(slope(scene, camera, shot, 256), -0.85);
}

TEST(Convergence, NoPictureConvergesSlowerThanIndependentSampling) {
  const Shot shot{.size = {.width = 24, .height = 18}};
  EXPECT_LT(slope(still_life(), kCamera, shot, 64), -0.5);
}

// Compares pictures with few samples and 16 seeds with a reference. The error of each pixel's mean,
// divided by its estimated deviation, follows Student's t distribution with n = 15 degrees of
// freedom. The mean of its square is n / (n - 2), and it exceeds 3.6 in one of about 270 cases.
TEST(Convergence, PicturesWithFewSamplesAreUnbiased) {
  const auto effort = std::max(std::uint32_t(traversal::ray_count(1e-6)), 1U);
  constexpr std::uint32_t seeds = 16;
  Shot shot{.size = {.width = 32, .height = 24}, .samples = 512 * effort, .seed = 1000};
  const auto right = pixels_of(shoot(still_life(), kCamera, shot));
  shot.samples = 4 * effort;
  std::vector<std::vector<double>> values(right.size());
  for (shot.seed = 0; shot.seed < seeds; ++shot.seed) {
    const auto picture = pixels_of(shoot(still_life(), kCamera, shot));
    for (std::size_t i = 0; i < picture.size(); ++i) values[i].push_back(picture[i].y);
  }
  double far = 0, sum = 0, squares = 0, n = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const Estimate pixel(values[i]);
    if (pixel.deviation == 0) {
      ASSERT_EQ(pixel.mean, right[i].y);
      continue;
    }
    ++n;
    // The reference has an error too. Its variance is at most that of 512 samples, compared with 16
    // * 4 samples here.
    const double t = (pixel.mean - right[i].y) / (pixel.deviation * std::sqrt(1 + 64.0 / 512));
    far += std::abs(t) > 3.6 ? 1 : 0;
    sum += t;
    squares += t * t;
  }
  EXPECT_GT(n, right.size() / 2);
  EXPECT_NEAR(sum / n, 0, 5 * std::sqrt(15.0 / 13) / std::sqrt(n));
  EXPECT_LT(squares / n, 1.5);
  EXPECT_LT(far / n, 0.02);
}

// Alpha must end paths with the correct probability, even over many layers.
TEST(Convergence, LayersTransmitByOpacity) {
  Scene scene;
  scene.materials = {{.base_color = {0, 0, 0, 0.25F}, .alpha_mode = AlphaMode::blend},
                     {.emissive = Vec3(1)}};
  for (int i = 1; i <= 4; ++i) {
    scene.objects.push_back({.name = "pane",
                             .shape = parallelogram({-9, -9, -float(i)}, {18, 0, 0}, {0, 18, 0}),
                             .material = 0});
  }
  scene.objects.push_back({.name = "wall", .shape = Plane{{0, 0, -9}, {0, 0, 1}}, .material = 1});
  scene.environment = Environment{.content = Vec3(0)};
  const Shot shot{.size = {.width = 32, .height = 32}, .samples = 64, .max_depth = 1};
  const double share = 0.75 * 0.75 * 0.75 * 0.75;
  const double expected_squares = share * (1 - share) / 64;
  const auto pixels = pixels_of(shoot(scene, PerspectiveCamera{}, shot));
  double sum = 0, squares = 0;
  for (const DVec3& pixel : pixels) {
    sum += pixel.y;
    squares += (pixel.y - share) * (pixel.y - share);
  }
  const auto n = double(pixels.size());
  EXPECT_NEAR(sum / n, share, 5 * std::sqrt(expected_squares / n));
  // Sobol points have a smaller variance than independent samples.
  EXPECT_LT(squares / n, expected_squares);
}

}  // namespace
}  // namespace microtrace
