/// Tests the sampling of environments that light a room through a window.
#include "render/lighting/sky_visibility.hpp"
#include "render/prepared/content.hpp"
#include "render/sampling/sobol.hpp"
#include "support/pictures.hpp"
#include "support/shading/chi_square.hpp"
#include "support/shading/light_samples.hpp"

#include <microtrace/prepared_scene.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr float kRadiance = 3, kReflectance = 0.5F;
constexpr std::uint32_t kBlack = 0, kGray = 1;

/// The window in the wall at x = 2.
constexpr float kLow = -0.2F, kHigh = 0.4F, kLeft = -0.4F, kRight = 0.4F;

void add(Scene& scene, const Vec3& corner, const Vec3& along, const Vec3& up,
         std::uint32_t material = kBlack) {
  scene.objects.push_back(
      {.name = "wall", .shape = parallelogram(corner, along, up), .material = material});
}

/// Returns a room from (-2, -1, -2) to (2, 1, 2) with a gray floor, a black rest and a window.
Scene room() {
  Scene scene;
  const Specular none{.factor = 0};
  for (const float color : {0.0F, kReflectance}) {
    scene.materials.push_back(
        {.base_color = Vec4(Vec3(color), 1), .metallic = 0, .specular = none});
    scene.materials.back().double_sided = true;
  }
  add(scene, {-2, -1, 2}, {4, 0, 0}, {0, 0, -4}, kGray);
  add(scene, {-2, 1, 2}, {4, 0, 0}, {0, 0, -4});
  add(scene, {-2, -1, -2}, {4, 0, 0}, {0, 2, 0});
  add(scene, {-2, -1, 2}, {4, 0, 0}, {0, 2, 0});
  add(scene, {-2, -1, -2}, {0, 0, 4}, {0, 2, 0});
  add(scene, {2, -1, -2}, {0, 0, 4}, {0, kLow + 1, 0});
  add(scene, {2, kHigh, -2}, {0, 0, 4}, {0, 1 - kHigh, 0});
  add(scene, {2, kLow, -2}, {0, 0, kLeft + 2}, {0, kHigh - kLow, 0});
  add(scene, {2, kLow, kRight}, {0, 0, 2 - kRight}, {0, kHigh - kLow, 0});
  scene.environment = Environment{.content = Vec3(kRadiance)};
  return scene;
}

Scene scaled_room(float factor) {
  Scene scene = room();
  for (Object& object : scene.objects) {
    Mesh& mesh = std::get<Mesh>(object.shape);
    std::vector<Vec3> positions;
    for (const Vec3& p : mesh.positions) positions.push_back(p * factor);
    mesh.positions = positions;
  }
  return scene;
}

/// Returns the fraction of a point's irradiance under an unoccluded sky that the window lets in.
double form_factor(const DVec3& p, const DVec3& n) {
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const DVec3 at(2, double{kLow} + double{kHigh - kLow} * (i + 0.5) / kSteps,
                     double{kLeft} + double{kRight - kLeft} * (j + 0.5) / kSteps);
      const DVec3 d = at - p;
      const double square = glm::dot(d, d);
      sum += std::max(glm::dot(d, n), 0.0) * d.x / (square * square);
    }
  }
  return sum * double{kHigh - kLow} * double{kRight - kLeft} / (kSteps * kSteps * std::numbers::pi);
}

/// Returns a camera that sees only a small part of the surface at p, along its normal n.
Camera at(const DVec3& p, const DVec3& n) {
  return OrthographicCamera{
      .pose = {.position = p + 0.1 * n, .direction = -n, .up = {n.y, n.z, n.x}}, .height = 1e-3};
}

void expect_radiance(const Scene& scene, const DVec3& p, const DVec3& n) {
  constexpr std::uint32_t kSamples = 64, kPictures = 40;
  const Shot shot{.size = {2, 2}, .samples = kSamples, .max_depth = 2};
  const Estimate found = estimate(scene, at(p, n), shot, kPictures);
  const double expected = double{kRadiance} * double{kReflectance} * form_factor(p, n);
  EXPECT_NEAR(found.mean, expected, 4.5 * found.deviation);
  // Without the guide, only about one in a hundred directions finds the window, and the deviation
  // of one sample is ten times the mean.
  EXPECT_LT(found.deviation * std::sqrt(4.0 * kSamples * kPictures), 3 * expected);
}

TEST(Window, FloorHasTheRadianceOfTheFormFactor) {
  const Scene scene = room();
  for (const DVec2& place : {DVec2(0, 0), DVec2(-1.7, 1.3), DVec2(1.2, -0.5)})
    expect_radiance(scene, {place.x, -1, place.y}, {0, 1, 0});
}

TEST(Window, SlantedSurfaceHasTheRadianceOfTheFormFactor) {
  Scene scene = room();
  add(scene, {-0.5F, -0.5F, -0.5F}, {1, -0.5F, 0}, {0.25F, 0.5F, -0.75F}, kGray);
  const Vec3 n = glm::normalize(glm::cross(Vec3(1, -0.5F, 0), Vec3(0.25F, 0.5F, -0.75F)));
  const DVec3 p(-0.5 + 0.5 + 0.125, -0.5 - 0.25 + 0.25, -0.5 - 0.375);
  expect_radiance(scene, p, DVec3(n.x > 0 ? n : -n));
}

TEST(Window, MapsHaveTheLightOfTheUniformSky) {
  Scene scene = room();
  scene.environment->content = std::make_shared<const RadianceMap>(
      RadianceMap{.width = 2, .height = 1, .pixels = {Vec3(kRadiance), Vec3(kRadiance)}});
  const DVec3 p(0.5, -1, 0.5), n(0, 1, 0);
  const Estimate found =
      estimate(scene, at(p, n), {.size = {2, 2}, .samples = 64, .max_depth = 2}, 40);
  EXPECT_NEAR(found.mean, double{kRadiance} * double{kReflectance} * form_factor(p, n),
              4.5 * found.deviation);
}

TEST(Window, SamplesHaveTheirPdf) {
  const PreparedScene prepared(room(), {.threads = 1});
  const Lighting lighting = prepared.content().lighting({});
  constexpr int kRows = 16, kColumns = 32, kFine = 24, kSamples = 200000;
  const auto cell_of = [](const Vec3& d) {
    const double u = std::atan2(double{d.z}, double{d.x}) / (2 * std::numbers::pi) + 0.5;
    const auto row = std::min(int((double{d.y} + 1) / 2 * kRows), kRows - 1);
    return std::size_t(row * kColumns + std::min(int(u * kColumns), kColumns - 1));
  };
  for (const LightSampleContext& context :
       {LightSampleContext{.p = {0, -1, 0}, .n = {0, 1, 0}},
        LightSampleContext{.p = {-2, 0, 1}, .n = {0.8F, 0, 0.6F}}}) {
    std::vector<double> counts(kRows * kColumns), expected(kRows * kColumns);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> u(0, 0x0.ffffffp0F);
    for (int i = 0; i < kSamples; ++i) {
      const Vec2 place(u(random), u(random));
      const auto light = light_sample(lighting, context, place, u(random));
      ASSERT_TRUE(light);
      ASSERT_NEAR(glm::dot(light->wi, light->wi), 1, 1e-5);
      ++counts[cell_of(light->wi)];
    }
    double within = 0;
    for (int row = 0; row < kRows * kFine; ++row) {
      const double y = 2 * (row + 0.5) / (kRows * kFine) - 1, r = std::sqrt(1 - y * y);
      for (int column = 0; column < kColumns * kFine; ++column) {
        const double phi = ((column + 0.5) / (kColumns * kFine) - 0.5) * 2 * std::numbers::pi;
        const Vec3 d(DVec3(r * std::cos(phi), y, r * std::sin(phi)));
        const double mass = double{environment_pdf(lighting, context, d)} * 4 * std::numbers::pi /
                            (kRows * kColumns * kFine * kFine);
        expected[cell_of(d)] += mass * kSamples;
        within += mass;
      }
    }
    EXPECT_NEAR(within, 1, 0.002);
    EXPECT_LT(chi_square_excess(counts, expected), 5.5);
  }
}

TEST(Window, ThreadsAndOrderDoNotChangeTheBytes) {
  const Scene scene = room();
  const PerspectiveCamera camera{.pose = {.position = {-1.9, 0, 1.9}, .direction = {1, -0.3, -1}}};
  const Film one = shoot(scene, camera, {.size = {48, 32}, .samples = 4, .threads = 1});
  const Film three = shoot(scene, camera, {.size = {48, 32}, .samples = 4, .threads = 3});
  EXPECT_EQ(pixels_of(one), pixels_of(three));
}

TEST(Window, HugeRoomsAreRendered) {
  const Scene scene = scaled_room(0x1.fcp126F);
  const PerspectiveCamera camera{.pose = {.position = {-0x1p126, 0, 0}, .direction = {1, -0.3, 0}}};
  // All arithmetic is exact and slow at this size.
  const Film film = shoot(scene, camera, {.size = {2, 2}, .samples = 2, .max_depth = 2});
  EXPECT_TRUE(std::isfinite(mean_of(film).y));
}

bool is_enclosed(const Scene& scene) {
  const PreparedScene prepared(scene, {.threads = 1});
  return SkyVisibility(scene, prepared.bvh(), prepared.content().shading()).is_enclosed();
}

TEST(Window, OnlyEnclosedScenesAreGuided) {
  Scene scene = room();
  EXPECT_TRUE(is_enclosed(scene));
  Scene open = scene;
  open.objects.erase(open.objects.begin() + 1);
  EXPECT_FALSE(is_enclosed(open)) << "no ceiling";
  for (Material& material : scene.materials) material.double_sided = false;
  EXPECT_FALSE(is_enclosed(scene)) << "light passes through the backs of walls";
  scene.objects.clear();
  EXPECT_FALSE(is_enclosed(scene));
}

// Most rays between particles hit one, but the visibility in cells that are wider than these
// distances says little.
TEST(Window, CloudsOfParticlesAreNotGuided) {
  Scene cloud;
  for (std::uint32_t i = 0; i < 8000; ++i) {
    const sampling::Sobol place(1, i);
    const Vec2 xy = place.pair(0), z = place.pair(1);
    cloud.objects.push_back(
        {.name = "particle", .shape = Sphere{{100 * xy.x, 100 * xy.y, 100 * z.x}, 2.25F}});
  }
  EXPECT_FALSE(is_enclosed(cloud));
}

// Rays from farther points are tested against all primitives, which may take hours.
TEST(Window, ScenesBeyondTheKernelsLimitsAreNotProbed) {
  EXPECT_TRUE(is_enclosed(scaled_room(0x1p36F)));
  EXPECT_FALSE(is_enclosed(scaled_room(0x1p40F)));
}

/// Adds an object with a material of its own in front of the window.
Scene closed_by(const Material& material, Shape shape) {
  Scene scene = room();
  scene.objects.push_back({.name = "pane",
                           .shape = std::move(shape),
                           .material = static_cast<std::uint32_t>(scene.materials.size())});
  scene.materials.push_back(material);
  return scene;
}

/// Returns the fraction of light from each bin at the middle of the floor.
std::vector<double> light_on_floor(const Scene& scene) {
  const PreparedScene prepared(scene, {.threads = 1});
  const SkyVisibility visibility(scene, prepared.bvh(), prepared.content().shading());
  const auto& bins = visibility.cell(visibility.index({0, -1, 0}, {0, 1, 0})).bins;
  return {bins.begin(), bins.end()};
}

TEST(Window, CellsSeeTheLightThatPassesThePane) {
  const std::vector<double> open = light_on_floor(room()), none(open.size());
  ASSERT_NE(open, none);
  const Vec3 corner(2, kLow, kLeft), up(0, kHigh - kLow, 0), along(0, 0, kRight - kLeft);
  const Shape inwards = parallelogram(corner, along, up),
              outwards = parallelogram(corner, up, along);
  Material wall, lamp, glass, masked, one_sided;
  glass.alpha_mode = AlphaMode::blend;
  glass.base_color.w = 0.25F;
  EXPECT_EQ(light_on_floor(closed_by(wall, inwards)), none);
  lamp.emissive = Vec3(1);
  EXPECT_EQ(light_on_floor(closed_by(lamp, inwards)), none);
  masked.alpha_mode = AlphaMode::mask;
  masked.base_color.w = 0.25F;
  EXPECT_EQ(light_on_floor(closed_by(masked, inwards)), open);
  masked.alpha_cutoff = 0.125F;
  EXPECT_EQ(light_on_floor(closed_by(masked, inwards)), none);
  const std::vector<double> dimmed = light_on_floor(closed_by(glass, inwards));
  for (std::size_t bin = 0; bin < open.size(); ++bin) EXPECT_NEAR(dimmed[bin], 0.75 * open[bin], 1);
  one_sided.double_sided = false;
  EXPECT_EQ(light_on_floor(closed_by(one_sided, inwards)), open);
  EXPECT_EQ(light_on_floor(closed_by(one_sided, outwards)), none);
  const auto disc = [](float direction) {
    return Disc{.center = {1.999F, 0.1F, 0}, .normal = {direction, 0, 0}, .radius = 0.6F};
  };
  EXPECT_EQ(light_on_floor(closed_by(one_sided, disc(-1))), open);
  EXPECT_EQ(light_on_floor(closed_by(one_sided, disc(1))), none);
}

TEST(HemisphereBins, DirectionsAreInTheirBins) {
  for (int axis = 0; axis < 6; ++axis) {
    const HemisphereBins bins({.axis = axis / 2, .is_down = axis % 2 != 0});
    for (int bin = 0; bin < HemisphereBins::kCount; ++bin) {
      for (const Vec2& place : {Vec2(0.01F, 0.01F), Vec2(0.5F, 0.5F), Vec2(0.99F, 0.99F)}) {
        const Vec3 d = bins.direction(bin, place);
        EXPECT_NEAR(glm::dot(d, d), 1, 1e-6);
        EXPECT_EQ(bins.bin(d), bin);
        EXPECT_EQ(bins.bin(-d), -1);
      }
    }
  }
}

}  // namespace
}  // namespace microtrace
