/// Compares directions from light sampling with the pdf of light sampling.
#include "render/prepared/content.hpp"
#include "support/pi.hpp"
#include "support/pictures.hpp"
#include "support/shading/chi_square.hpp"
#include "support/shading/light_samples.hpp"

#include <microtrace/prepared_scene.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr int kRows = 16, kColumns = 32;

/// Returns the index of the direction's cell. All cells have the same solid angle.
std::size_t cell_of(const Vec3& d) {
  const double u = std::atan2(double{d.z}, double{d.x}) / (2 * kPi) + 0.5;
  const auto row = std::min(int((double{d.y} + 1) / 2 * kRows), kRows - 1);
  return std::size_t(row * kColumns + std::min(int(u * kColumns), kColumns - 1));
}

/// Returns a scene with area lights on all sides of the origin. They are one-sided or two-sided,
/// and face the origin or not. A large one is close, and some are shapes. The map has a bright
/// spot.
Scene lamps(bool with_map) {
  Scene scene;
  scene.materials = {{.double_sided = false, .emissive = Vec3(3)}, {.emissive = Vec3(1)}};
  std::mt19937 random(8);
  std::uniform_real_distribution<float> u(-1, 1);
  const auto vector = [&] { return Vec3(u(random), u(random), u(random)); };
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Vec3 to_light = vector();
    scene.objects.push_back(
        {.name = "lamp",
         .shape = parallelogram(to_light * (4 / std::sqrt(glm::dot(to_light, to_light))),
                                vector() * 1.5F, vector() * 1.5F),
         .material = i % 2});
  }
  scene.objects.push_back(
      {.name = "close", .shape = parallelogram({-3, -1, -3}, {0, 0, 6}, {6, 0, 0}), .material = 1});
  scene.objects.push_back({.name = "ball", .shape = Sphere{{2, 2, 1}, 0.8F}, .material = 0});
  scene.objects.push_back(
      {.name = "disc", .shape = Disc{{1, 2, -3}, {-0.2F, -0.5F, 2}, 0.9F}, .material = 1});
  scene.objects.push_back(
      {.name = "triangle", .shape = Triangle{{-3, 1, 1}, {-3, 2, 0}, {-2, 2, 1}}, .material = 1});
  RadianceMap map{.width = 16, .height = 8};
  for (std::uint32_t i = 0; i < 16 * 8; ++i) map.pixels.emplace_back(i == 37 ? 40.0F : 0.5F);
  scene.environment = Environment{.content = Vec3(0)};
  if (with_map) scene.environment->content = std::make_shared<const RadianceMap>(map);
  return scene;
}

/// Returns the sum of the pdfs of all lights in a direction, including hidden lights.
double pdf(const Lighting& lighting, const Shading& shading, const Bvh& bvh,
           const LightSampleContext& context, const Vec3& d) {
  double sum = double{environment_pdf(lighting, context, d)};
  const Ray ray{.o = context.p, .t_min = 0, .d = d};
  for (std::optional<Hit> hit = bvh.intersect(ray); hit; hit = bvh.next(ray, *hit)) {
    const ShadingPoint point = shading.point(ray, *hit);
    if (shading.emission(point) == Vec3(0) || shading.coverage(point, false) == 0) continue;
    const float cosine = std::abs(glm::dot(d, point.at.n));
    sum += double{lighting.emitter_pdf(hit->id, context, point.at.distance, cosine)};
  }
  return sum;
}

class Lamps : public testing::TestWithParam<bool> {};

TEST_P(Lamps, SamplesHaveTheirPdf) {
  const Scene scene = lamps(GetParam());
  const PreparedScene prepared(scene, {.threads = 1});
  const Bvh& bvh = prepared.bvh();
  const Shading& shading = prepared.content().shading();
  const Lighting lighting = prepared.content().lighting({});
  for (const LightSampleContext& context :
       {LightSampleContext{.p = {0, 0, 0}, .n = {0, 1, 0}},
        LightSampleContext{.p = {0.5F, -0.9F, 0.25F}, .n = {0.6F, 0.8F, 0}}}) {
    constexpr int samples = 200000, fine = 48;
    std::vector<double> counts(kRows * kColumns + 1), expected(kRows * kColumns + 1);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> u(0, 0x0.ffffffp0F);
    int differ = 0;
    for (int i = 0; i < samples; ++i) {
      const Vec2 place(u(random), u(random));
      const auto light = light_sample(lighting, context, place, u(random));
      ++counts[light ? cell_of(light->wi) : counts.size() - 1];
      if (!light || i >= 2000) continue;
      // Compares the sample's own pdf, which excludes other lights in the same direction.
      ASSERT_NEAR(glm::dot(light->wi, light->wi), 1, 1e-5);
      differ += double{light->pdf} > 1.01 * pdf(lighting, shading, bvh, context, light->wi) + 1e-6
                    ? 1
                    : 0;
    }
    EXPECT_LE(differ, 10);  // samples at edges of lights and of the map's pixels
    double within = 0;
    for (int row = 0; row < kRows * fine; ++row) {
      const double y = 2 * (row + 0.5) / (kRows * fine) - 1, r = std::sqrt(1 - y * y);
      for (int column = 0; column < kColumns * fine; ++column) {
        const double phi = ((column + 0.5) / (kColumns * fine) - 0.5) * 2 * kPi;
        const Vec3 d(DVec3(r * std::cos(phi), y, r * std::sin(phi)));
        const double mass =
            pdf(lighting, shading, bvh, context, d) * 4 * kPi / (kRows * kColumns * fine * fine);
        expected[cell_of(d)] += mass * samples;
        within += mass;
      }
    }
    expected.back() = std::max(1 - within, 0.0) * samples;
    EXPECT_LT(within, 1.002);
    EXPECT_LT(chi_square_excess(counts, expected), 5.5) << within;
  }
}

INSTANTIATE_TEST_SUITE_P(Environment, Lamps, testing::Bool());

// Samples of a light must be uniform over each of its triangles.
TEST(Lighting, PointsOnAnEmitterAreUniform) {
  Scene scene;
  scene.materials = {{.emissive = Vec3(1)}};
  scene.objects.push_back(
      {.name = "lamp", .shape = parallelogram({0, 2, 0}, {2, 0, 0}, {1, 0, 3}), .material = 0});
  scene.environment = Environment{.content = Vec3(0)};
  const PreparedScene prepared(scene, {.threads = 1});
  const Lighting lighting = prepared.content().lighting({});
  const LightSampleContext context{.p = {1.5F, 0, 1.5F}, .n = {0, 1, 0}};
  std::mt19937 random(2);
  std::uniform_real_distribution<float> u(0, 0x0.ffffffp0F);
  constexpr int samples = 100000, side = 10, half = side / 2;
  // The probability of a triangle depends on its contribution at the context's point, so samples
  // are counted separately for each triangle, in side x half cells of equal area.
  std::array<std::vector<double>, 2> counts{std::vector<double>(side * half),
                                            std::vector<double>(side * half)};
  std::array<double, 2> all{};
  for (int i = 0; i < samples; ++i) {
    const Vec2 place(u(random), u(random));
    const auto light = light_sample(lighting, context, place, u(random));
    ASSERT_TRUE(light && light->target);
    const DVec3 p = DVec3(context.p) + DVec3(light->to_light);
    const double b = p.z / 3, a = (p.x - b) / 2;  // coordinates along the edges `along` and `up`
    const auto triangle = std::size_t(*light->target);
    // Coordinates that are uniform over the triangle: s depends on the distance from the shared
    // corner, t on the position across.
    const double low = triangle == 0 ? b : a, high = triangle == 0 ? a : b;
    const double s = std::clamp(high * high, 0.0, 1 - 1e-9),
                 t = std::clamp(low / high, 0.0, 1 - 1e-9);
    ++counts[triangle][std::size_t(s * side) * half + std::size_t(t * half)];
    ++all[triangle];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<double> expected(counts[i].size(), all[i] / double(counts[i].size()));
    EXPECT_LT(chi_square_excess(counts[i], expected), 5) << i;
  }
}

/// Returns a square of this many cells, whose front points down.
Mesh square_lamp(const Vec3& corner, float side, std::uint32_t cells) {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t row = 0; row <= cells; ++row) {
    for (std::uint32_t column = 0; column <= cells; ++column) {
      const Vec2 at(column, row);
      positions.push_back(corner + Vec3(at.x, 0, at.y) * (side / static_cast<float>(cells)));
      if (row == cells || column == cells) continue;
      const std::uint32_t first = row * (cells + 1) + column, next = first + cells + 1;
      triangles.push_back({{first, first + 1, next + 1}});
      triangles.push_back({{first, next + 1, next}});
    }
  }
  return {.positions = std::move(positions), .triangles = std::move(triangles)};
}

// Rounding of directions makes many shadow rays hit a neighbor of the triangle at which they were
// aimed. The quadric keeps the scene from being moved to the origin.
TEST(Lighting, FineEmittersFarFromTheOriginAreAsBrightAsCoarseOnes) {
  const Vec3 center(150, 100, 200);
  const auto brightness = [&](std::uint32_t cells) {
    Scene scene;
    scene.materials = {{.metallic = 0},
                       {.base_color = Vec4(0), .metallic = 0, .emissive = Vec3(1000)}};
    scene.objects = {
        {.name = "floor",
         .shape = parallelogram(center - Vec3(1, 0, 1), {0, 0, 2}, {2, 0, 0}),
         .material = 0},
        {.name = "lamp", .shape = square_lamp(center + Vec3(0, 1, 0), 0.01F, cells), .material = 1},
        {.name = "quadric", .shape = Quadric{.a = 1, .b = 1, .c = 1, .j = -1}}};
    scene.environment = Environment{.content = Vec3(0)};
    const PerspectiveCamera camera{
        .pose = {.position = DVec3(center) + DVec3(0, 0.5, 0.5), .direction = {0, -1, -1}},
        .vertical_fov = 0.5};
    return mean_of(shoot(scene, camera, {.samples = 256, .max_depth = 2})).y;
  };
  const double coarse = brightness(1);
  EXPECT_GT(coarse, 0);
  EXPECT_NEAR(brightness(128) / coarse, 1, 0.005);
}

}  // namespace
}  // namespace microtrace
