#include "render/lighting/hemisphere_distribution.hpp"
#include "scene/math/luminance.hpp"

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kGroundSize{.width = 24, .height = 24};
constexpr double kExtent = 4;  // the cameras below see a square of this size

struct Setting {
  std::optional<Ground> ground = Ground{.height = 0};
  Backfaces backfaces = Backfaces::pass;
  std::uint32_t samples = 16;
  bool transparent = true;
};

Film draw(const Scene& scene, const Camera& camera, const Setting& setting = {}) {
  const PathIntegrator path({.backfaces = setting.backfaces, .ground = setting.ground});
  return render(scene, camera, kGroundSize,
                {.threads = 1,
                 .integrator = &path,
                 .samples = setting.samples,
                 .transparent = setting.transparent});
}

/// A camera below the shapes that looks straight down. Up in the picture is -z.
Camera from_above(double height) {
  return OrthographicCamera{
      .pose = {.position = {0, height, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}},
      .height = kExtent};
}

/// The point on the ground at a pixel's center.
DVec3 ground_point(std::uint32_t x, std::uint32_t y) {
  return {((x + 0.5) / kGroundSize.width - 0.5) * kExtent, 0,
          ((y + 0.5) / kGroundSize.height - 0.5) * kExtent};
}

/// Calls f(ground point, alpha) for each pixel.
template <class F>
void for_each_pixel(Film film, const F& f) {
  for (std::uint32_t y = 0; y < kGroundSize.height; ++y) {
    for (std::uint32_t x = 0; x < kGroundSize.width; ++x)
      f(ground_point(x, y), double{film.alpha_at(x, y)});
  }
}

Scene scene_of(Shape shape, Environment environment) {
  Scene scene;
  scene.materials = {{.base_color = Vec4(0.5F, 0.5F, 0.5F, 1)}};
  scene.objects.push_back({.name = "shape", .shape = std::move(shape), .material = 0});
  scene.environment = std::move(environment);
  return scene;
}

Environment uniform(float radiance) {
  return {.content = Vec3(radiance)};
}

/// The fraction of a uniform hemisphere's irradiance that a disc blocks. The disc is parallel to
/// the surface, at the height h, and its axis is at the distance a (J. Howell, A catalog of
/// radiation heat transfer configuration factors, B-13).
double blocked_by_disc(double a, double h, double radius) {
  const double b = h * h + a * a + radius * radius;
  return (1 - (b - 2 * radius * radius) / std::sqrt(b * b - 4 * a * a * radius * radius)) / 2;
}

TEST(Ground, ShowsTheClosedFormBelowADisc) {
  const Scene scene = scene_of(Disc{{0, 1, 0}, {0, 1, 0}, 0.8F}, uniform(3));
  const Film film = draw(scene, from_above(0.5), {.samples = 1024});
  double difference = 0, greatest = 0;
  for_each_pixel(film, [&](const DVec3& p, double alpha) {
    const double expected = blocked_by_disc(std::hypot(p.x, p.z), 1, 0.8);
    difference += (alpha - expected) / (kGroundSize.width * kGroundSize.height);
    greatest = std::max(greatest, std::abs(alpha - expected));
  });
  EXPECT_NEAR(difference, 0, 1e-3);
  EXPECT_LT(greatest, 0.06);
  for (std::uint32_t y = 0; y < kGroundSize.height; ++y) {
    for (const Vec3& color : film.row(y)) EXPECT_EQ(color, Vec3(0));
  }
}

TEST(Ground, LightPassesOneSidedSurfacesAsInTheRestOfThePicture) {
  Scene scene = scene_of(Disc{{0, 1, 0}, {0, 1, 0}, 100}, uniform(1));
  scene.materials[0].double_sided = false;
  const auto mean = [&](Backfaces backfaces) {
    double sum = 0;
    for_each_pixel(draw(scene, from_above(0.5), {.backfaces = backfaces}),
                   [&](const DVec3&, double alpha) { sum += alpha; });
    return sum / (kGroundSize.width * kGroundSize.height);
  };
  EXPECT_GT(mean(Backfaces::occlude), 0.99);
  // The rays from the ground meet the back, which light from above leaves through.
  scene.objects[0].shape = Disc{{0, 1, 0}, {0, -1, 0}, 100};
  EXPECT_GT(mean(Backfaces::occlude), 0.99);
  EXPECT_LT(mean(Backfaces::pass), 0.01);
}

/// A map that is black except for a pixel, and the direction of that pixel.
struct Sun {
  std::shared_ptr<RadianceMap> map;
  DVec3 direction;

  Sun() : map(std::make_shared<RadianceMap>()) {
    constexpr std::uint32_t kWidth = 512, kHeight = 256, kX = 100, kY = 70;
    *map = {.width = kWidth, .height = kHeight};
    map->pixels.resize(std::size_t{kWidth} * kHeight);
    map->pixels[std::size_t{kY} * kWidth + kX] = Vec3(1000);
    const double phi = ((kX + 0.5) / kWidth - 0.5) * 2 * std::numbers::pi;
    const double theta = (kY + 0.5) / kHeight * std::numbers::pi;
    direction = {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
  }
};

TEST(Ground, ShowsTheSharpShadowOfASun) {
  const Sun sun;
  const Sphere sphere{{0, 1.5F, 0}, 0.5F};
  Scene by_map = scene_of(sphere, {.content = sun.map});
  Scene by_light = scene_of(sphere, uniform(0));
  by_light.lights = {{.name = "sun", .light = DirectionalLight{.direction = -sun.direction}}};
  for (const Scene& scene : {by_map, by_light}) {
    int dark = 0;
    for_each_pixel(draw(scene, from_above(0.9)), [&](const DVec3& p, double alpha) {
      const DVec3 to_center = DVec3(sphere.center) - p;
      const DVec3 across = to_center - glm::dot(to_center, sun.direction) * sun.direction;
      const double distance = std::sqrt(glm::dot(across, across));
      if (std::abs(distance - 0.5) < 0.15) return;  // half a pixel and the sun's size
      EXPECT_EQ(alpha, distance < 0.5 ? 1 : 0) << p.x << " " << p.z;
      dark += alpha == 1 ? 1 : 0;
    });
    EXPECT_GT(dark, 10);
  }
}

TEST(Ground, SharesOfSeveralLightsAddUp) {
  // The disc blocks the first light everywhere, and no other light.
  Scene scene = scene_of(Disc{{0, 10, 0}, {0, 1, 0}, 8}, uniform(0.01F));
  const DVec3 high(0, 20, 0), low(1, 5, 0);
  scene.lights = {{.name = "high", .light = PointLight{.position = high, .intensity = 300}},
                  {.name = "low", .light = PointLight{.position = low, .intensity = 10}},
                  {.name = "below", .light = PointLight{.position = {0, -1, 0}}},
                  {.name = "dark", .light = PointLight{.position = low, .intensity = 0}}};
  const auto irradiance = [](const DVec3& position, double intensity, const DVec3& p) {
    const DVec3 d = position - p;
    return intensity * d.y / std::pow(glm::dot(d, d), 1.5);
  };
  double greatest = 0;
  for_each_pixel(draw(scene, from_above(4), {.samples = 1024}), [&](const DVec3& p, double alpha) {
    const double a = irradiance(high, 300, p), b = irradiance(low, 10, p);
    const double sky = 0.01 * std::numbers::pi;
    const double expected =
        (a + sky * blocked_by_disc(std::hypot(p.x, p.z), 10, 8)) / (a + b + sky);
    greatest = std::max(greatest, std::abs(alpha - expected));
  });
  EXPECT_LT(greatest, 0.05);
}

TEST(Ground, TransparentSurfacesCastLighterShadows) {
  Scene scene = scene_of(Disc{{0, 1, 0}, {0, 1, 0}, 100}, uniform(0));
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color.w = 0.25F;
  scene.lights = {{.name = "sun", .light = DirectionalLight{.direction = {0, -1, 0}}}};
  for_each_pixel(draw(scene, from_above(0.5)),
                 [](const DVec3&, double alpha) { EXPECT_EQ(alpha, 0.25); });
}

std::vector<Vec4> rgba_of(Film film) {
  std::vector<Vec4> result;
  for (std::uint32_t y = 0; y < kGroundSize.height; ++y) {
    for (std::uint32_t x = 0; x < kGroundSize.width; ++x)
      result.emplace_back(film.at(x, y), film.has_alpha() ? film.alpha_at(x, y) : 1);
  }
  return result;
}

Camera from_the_side(const DVec3& by = DVec3(0)) {
  return PerspectiveCamera{
      .pose = {.position = DVec3(0, 3, 4) + by, .direction = {0, -0.6, -0.8}, .up = {0, 1, 0}}};
}

TEST(Ground, IsAtTheLowestPointByDefault) {
  Scene scene = scene_of(Sphere{{0, 0.5F, 0}, 1}, uniform(1));
  scene.objects.push_back(
      {.name = "lowest", .shape = Triangle{{1, -0.75F, 1}, {2, 0, 1}, {1, 1, 1}}, .material = {}});
  scene.objects.push_back({.name = "wall", .shape = Plane{{0, 0, 20}, {0, 0, -1}}, .material = {}});
  const Camera camera = from_the_side();
  const auto lowest = rgba_of(draw(scene, camera, {.ground = Ground{}}));
  EXPECT_EQ(lowest, rgba_of(draw(scene, camera, {.ground = Ground{.height = -0.75}})));
  EXPECT_TRUE(lowest != rgba_of(draw(scene, camera, {.ground = Ground{.height = -0.7}})));
  // The height is in world space.
  scene.origin = {5, 1000, 7};
  EXPECT_EQ(lowest, rgba_of(draw(scene, camera, {.ground = Ground{.height = 999.25}})));
  // Without bounded shapes there is no lowest point.
  scene.objects.erase(scene.objects.begin(), scene.objects.begin() + 2);
  EXPECT_EQ(rgba_of(draw(scene, camera, {.ground = Ground{}})),
            rgba_of(draw(scene, camera, {.ground = std::nullopt})));
}

TEST(Ground, DoesNotDependOnTheDistanceFromTheOrigin) {
  const DVec3 by(0x1p22, 0x1p21, -0x1p22);
  const auto box_at = [](const DVec3& o) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
      mesh.positions.push_back(Vec3(o + DVec3(i & 1, (i >> 1) & 1, i >> 2)));
    mesh.triangles = {{{0, 1, 3}}, {{0, 3, 2}}, {{4, 6, 7}}, {{4, 7, 5}}, {{0, 4, 5}}, {{0, 5, 1}},
                      {{2, 3, 7}}, {{2, 7, 6}}, {{0, 2, 6}}, {{0, 6, 4}}, {{1, 5, 7}}, {{1, 7, 3}}};
    return scene_of(std::move(mesh), uniform(1));
  };
  const Film near = draw(box_at(DVec3(0)), from_the_side(), {.ground = Ground{}});
  for (const std::optional<double> height : {std::optional<double>(), std::optional(by.y)}) {
    const Film far = draw(box_at(by), from_the_side(by), {.ground = Ground{.height = height}});
    EXPECT_EQ(rgba_of(near), rgba_of(far));
  }
}

TEST(Ground, ChangesOnlyPixelsThatShowIt) {
  const Scene scene = scene_of(Sphere{{0, 1, 0}, 1}, {.content = Studio{}});
  Film with = draw(scene, from_the_side()), without = draw(scene, from_the_side(), {.ground = {}});
  int covered = 0, shaded = 0;
  for (std::uint32_t y = 0; y < kGroundSize.height; ++y) {
    for (std::uint32_t x = 0; x < kGroundSize.width; ++x) {
      EXPECT_EQ(with.at(x, y), without.at(x, y));  // shadows are black
      const float alpha = without.alpha_at(x, y);
      EXPECT_GE(with.alpha_at(x, y), alpha);
      covered += alpha == 1 ? 1 : 0;
      shaded += alpha == 0 && with.alpha_at(x, y) > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(covered, 20);
  EXPECT_GT(shaded, 20);
}

TEST(Ground, DarkensTheBackground) {
  Scene scene = scene_of(Disc{{0, 1, 0}, {0, 1, 0}, 0.8F}, uniform(2));
  const Camera camera = from_above(0.5);
  Film alphas = draw(scene, camera);
  scene.background = Vec3(0.5F, 0.25F, 1);
  Film over = draw(scene, camera, {.transparent = false});
  scene.environment->is_background = true;
  Film environment = draw(scene, camera);
  for (std::uint32_t y = 0; y < kGroundSize.height; ++y) {
    for (std::uint32_t x = 0; x < kGroundSize.width; ++x) {
      const float light = 1 - alphas.alpha_at(x, y);
      EXPECT_NEAR(over.at(x, y).x, 0.5F * light, 1e-6);
      EXPECT_NEAR(over.at(x, y).z, light, 1e-6);
      EXPECT_NEAR(environment.at(x, y).y, 2 * light, 1e-6);
      EXPECT_EQ(environment.alpha_at(x, y), 1);
    }
  }
}

TEST(Ground, IsInvisibleFromBelowAndWithoutLight) {
  const Camera up =
      PerspectiveCamera{.pose = {.position = {0, -1, 0}, .direction = {0, 1, 0}, .up = {0, 0, 1}}};
  Scene scene = scene_of(Sphere{{0, 5, 0}, 0.1F}, uniform(1));
  EXPECT_EQ(rgba_of(draw(scene, up)), rgba_of(draw(scene, up, {.ground = {}})));
  scene = scene_of(Disc{{0, 1, 0}, {0, 1, 0}, 100}, uniform(0));
  for_each_pixel(draw(scene, from_above(0.5)),
                 [](const DVec3&, double alpha) { EXPECT_EQ(alpha, 0); });
}

TEST(HemisphereDistribution, HasTheIrradianceAndTheMoments) {
  auto map = std::make_shared<RadianceMap>(RadianceMap{.width = 48, .height = 25});
  for (std::uint32_t i = 0; i < 48 * 25; ++i)
    map->pixels.push_back(Vec3(static_cast<float>(i * i % 17)) * (i % 7 == 0 ? 20.0F : 0.25F));
  const EnvironmentLight light({.content = map, .rotation = 1, .intensity = 3});
  const HemisphereDistribution distribution(light);
  // Integrates luminance times cosine, and its first moments, by the midpoint rule.
  constexpr int kRows = 800;
  double sum = 0;
  DVec3 mean(0), sampled(0);
  for (int j = 0; j < kRows; ++j) {
    const double s = (j + 0.5) / kRows;
    for (int i = 0; i < 4 * kRows; ++i) {
      const double phi = (i + 0.5) / (4 * kRows) * 2 * std::numbers::pi;
      const DVec3 d(std::sqrt(s) * std::cos(phi), std::sqrt(1 - s), std::sqrt(s) * std::sin(phi));
      const double part = double{luminance(light.radiance(Vec3(d)))} / (4.0 * kRows * kRows);
      sum += part;
      mean += part * d;
    }
  }
  EXPECT_NEAR(distribution.irradiance(), sum, 0.01 * sum);
  constexpr int kSide = 512;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Vec3 d = distribution.sample(Vec2(DVec2(i + 0.5, j + 0.5) / double{kSide}));
      EXPECT_NEAR(glm::dot(d, d), 1, 1e-6);
      EXPECT_GE(d.y, 0);
      sampled += DVec3(d) / double{kSide * kSide};
    }
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(sampled[axis], mean[axis] / sum, 0.01) << axis;
}

}  // namespace
}  // namespace microtrace
