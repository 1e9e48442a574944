/// Tests path guiding: guided pictures have the mean of other pictures, less noise where light is
/// hard to find, and the same bytes for any number of threads.
#include "render/guiding/path_guide.hpp"

#include "support/pi.hpp"
#include "support/pictures.hpp"
#include "support/shading/chi_square.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <ranges>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

void add(Scene& scene, const Vec3& corner, const Vec3& along, const Vec3& up,
         std::uint32_t material) {
  scene.objects.push_back(
      {.name = "wall", .shape = parallelogram(corner, along, up), .material = material});
}

/// Returns two gray rooms, connected by a gap. The lamp is in the right one, the camera in the left
/// one. A smooth metal and a glass panel are in the left room.
Scene rooms() {
  Scene scene;
  scene.environment = Environment{.content = Vec3(0)};
  const Specular none{.factor = 0};
  scene.materials.push_back({.base_color = Vec4(0.7F), .metallic = 0, .specular = none});
  scene.materials.push_back({.base_color = Vec4(0), .metallic = 0, .specular = none});
  scene.materials.back().emissive = Vec3(40);
  scene.materials.push_back({.base_color = Vec4(0.9F), .metallic = 1, .roughness = 0.1F});
  scene.materials.push_back({.base_color = Vec4(1), .metallic = 0, .roughness = 0});
  scene.materials.back().transmission = Transmission{.factor = 1};
  for (Material& material : scene.materials) material.double_sided = true;
  add(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, 0);
  add(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 0);
  add(scene, {-1, -1, -1}, {0, 0, 2}, {0, 2, 0}, 0);
  add(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, 0);
  add(scene, {-1, -1, -1}, {2, 0, 0}, {0, 0, 2}, 0);
  add(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 0);
  add(scene, {0, -1, -0.8F}, {0, 0, 1.8F}, {0, 2, 0}, 0);
  add(scene, {0.4F, 0.99F, -0.2F}, {0.3F, 0, 0}, {0, 0, 0.3F}, 1);
  add(scene, {-0.9F, -0.9F, -0.9F}, {0.5F, 0, -0.05F}, {0, 0.5F, 0.1F}, 2);
  add(scene, {-0.5F, -0.9F, -0.7F}, {0.4F, 0, 0.1F}, {0, 0.6F, 0}, 3);
  return scene;
}

const PerspectiveCamera kCamera{
    .pose = {.position = {-0.7, 0.2, 0.9}, .direction = {0.2, -0.2, -1}}, .vertical_fov = 1};

TEST(PathGuide, GuidedPicturesHaveTheMeanOfOthersAndLessNoise) {
  const Scene scene = rooms();
  constexpr std::uint32_t kPictures = 6;
  Shot shot{.size = {24, 24}, .samples = 32, .max_depth = 12};
  const Estimate plain = estimate(scene, kCamera, shot, kPictures);
  shot.guiding = true;
  shot.seed = 100;
  const Estimate guided = estimate(scene, kCamera, shot, kPictures);
  EXPECT_NEAR(guided.mean, plain.mean, 4 * std::hypot(guided.deviation, plain.deviation));
  EXPECT_GT(guided.mean, 0);
  // The noise of pixels is less affected by chance than that of the means of pictures. Guides need
  // some samples to learn from.
  shot.samples = 128;
  const auto noise = [&](bool is_guided) {
    shot.guiding = is_guided;
    shot.seed = 1;
    const std::vector<DVec3> one = pixels_of(shoot(scene, kCamera, shot));
    shot.seed = 2;
    const std::vector<DVec3> other = pixels_of(shoot(scene, kCamera, shot));
    double sum = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
      const double a = one[i].y, b = other[i].y;
      sum += std::pow(a / (1 + a) - b / (1 + b), 2);
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(noise(true), 0.9 * noise(false));
}

TEST(PathGuide, ThreadsAndCropsDoNotChangeTheBytes) {
  const Scene scene = rooms();
  Shot shot{.size = {24, 16}, .samples = 2, .guiding = true};
  const Film one = shoot(scene, kCamera, shot);
  shot.threads = 3;
  EXPECT_EQ(pixels_of(one), pixels_of(shoot(scene, kCamera, shot)));
  const PathIntegrator path({.max_depth = shot.max_depth, .guiding = true});
  const PixelRect part{.x0 = 9, .y0 = 5, .x1 = 11, .y1 = 6};
  const Film crop = render(scene, kCamera, shot.size,
                           {.threads = 1, .integrator = &path, .samples = 2, .crop = part});
  EXPECT_EQ(crop.row(0)[1], one.row(5)[10]);
}

TEST(PathGuide, BlackScenesAreRendered) {
  Scene scene = rooms();
  scene.materials[1].emissive = Vec3(0);
  EXPECT_EQ(mean_of(shoot(scene, kCamera, {.size = {4, 4}, .samples = 1, .guiding = true})).y, 0);
}

TEST(PathGuide, ShuttersAreRefused) {
  const PathIntegrator path({.guiding = true});
  RenderOptions options{.integrator = &path, .shutter = Shutter{}};
  options.shutter->moment = [](double) -> Moment { throw std::bad_function_call(); };
  EXPECT_THROW((void)render(rooms(), kCamera, {4, 4}, options), Error);
}

/// Returns records of light from two small sources and of weak light from everywhere.
GuideRecords records() {
  GuideRecords all;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> u(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const HemisphereBins bins({.axis = 1});
    const Vec2 place(u(random), u(random));
    const int bin = i % 4 == 0 ? i / 4 % HemisphereBins::kCount : i % 4 == 1 ? 100 : 287;
    const Vec3 d = bins.direction(bin, i % 4 == 2 ? 0.2F * place : place);
    const Vec3 p(10 * u(random), 0, u(random) * u(random));
    all[face_index({.axis = 1})].push_back({.p = p, .d = d, .value = 0.5F + u(random)});
  }
  return all;
}

const PathGuide::Cell* cell_at(const PathGuide& guide, const Vec3& p, const Vec3& n) {
  std::array<const PathGuide::Cell*, 1> cell{};
  guide.find({&p.x, &p.y, &p.z}, {&n.x, &n.y, &n.z}, cell);
  return cell[0];
}

TEST(PathGuide, OrderOfRecordsDoesNotMatter) {
  GuideRecords all = records();
  const PathGuide one(all, 1);
  std::ranges::shuffle(all[face_index({.axis = 1})], std::mt19937(5));
  const PathGuide other(all, 1);
  for (const Vec3& p : {Vec3(0), Vec3(3, 0, 0.2F), Vec3(9.9F, 0, 0.9F), Vec3(-5, 0, 7)}) {
    const PathGuide::Cell* a = cell_at(one, p, {0, 1, 0});
    const PathGuide::Cell* b = cell_at(other, p, {0, 1, 0});
    ASSERT_TRUE(a != nullptr && b != nullptr);
    EXPECT_EQ(a->brightness, b->brightness);
    for (float x = 0.02F; x < 1; x += 0.05F)
      EXPECT_EQ(a->directions.sample({x, 0.3F}), b->directions.sample({x, 0.3F}));
  }
  EXPECT_EQ(cell_at(one, Vec3(0), {0, -1, 0}), nullptr);
}

// The ground is often an infinite plane, of which some paths see far parts.
TEST(PathGuide, FewFarRecordsLeaveTheCellsOfOthersSmall) {
  GuideRecords all = records();
  for (const float far : {-1e6F, 1e6F}) {
    for (int i = 0; i < 20; ++i)
      all[face_index({.axis = 1})].push_back({.p = {far, 0, far}, .d = {0, 1, 0}, .value = 1});
  }
  const PathGuide guide(all, 1);
  const PathGuide::Cell* cell = cell_at(guide, {1, 0, 0.5F}, {0, 1, 0});
  ASSERT_NE(cell, nullptr);
  EXPECT_NE(cell, cell_at(guide, {9, 0, 0.5F}, {0, 1, 0}));
}

TEST(PathGuide, FindsManyPointsLikeOne) {
  const PathGuide guide(records(), 1);
  std::mt19937 random(11);
  std::uniform_real_distribution<float> u(-1, 11);
  std::array<std::array<float, PathGuide::kMostPoints>, 3> p, n;
  for (auto* columns : {&p, &n}) {
    for (auto& column : *columns) std::ranges::generate(column, [&] { return u(random) - 2; });
  }
  n[1].fill(20);
  std::array<const PathGuide::Cell*, PathGuide::kMostPoints> cells{};
  guide.find({p[0].data(), p[1].data(), p[2].data()}, {n[0].data(), n[1].data(), n[2].data()},
             cells);
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_EQ(cells[i], cell_at(guide, {p[0][i], p[1][i], p[2][i]}, {0, 1, 0}));
  EXPECT_TRUE(std::ranges::any_of(cells, [&](const auto* cell) { return cell != cells[0]; }));
}

TEST(PathGuide, SamplesHaveTheirPdf) {
  const PathGuide guide(records(), 1);
  const PathGuide::Cell* cell = cell_at(guide, {5, 0, 0.3F}, {0, 1, 0});
  ASSERT_NE(cell, nullptr);
  constexpr int kParts = GuideTable::kEdge, kSamples = 400000;
  constexpr std::size_t kCells = std::size_t{HemisphereBins::kCount} * kParts * kParts;
  const HemisphereBins bins({.axis = 1});
  std::vector<double> counts(kCells), expected(kCells);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0, 0x0.ffffffp0F);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 d = cell->directions.sample({u(random), u(random)});
    ASSERT_NEAR(glm::dot(d, d), 1, 1e-5);
    const HemisphereBins::Place at = bins.place(d);
    ASSERT_GE(at.bin, 0);
    const int row = std::min(int(at.within.x * kParts), kParts - 1);
    const int column = std::min(int(at.within.y * kParts), kParts - 1);
    ++counts[std::size_t((at.bin * kParts + row) * kParts + column)];
  }
  double sum = 0;
  for (std::size_t i = 0; i < kCells; ++i) {
    const int part = int(i % (kParts * kParts));
    const Vec2 place((float(part / kParts) + 0.5F) / kParts,
                     (float(part % kParts) + 0.5F) / kParts);
    const Vec3 d = bins.direction(int(i / (kParts * kParts)), place);
    const double share = double{cell->directions.pdf(d)} * 2 * kPi / kCells;
    expected[i] = share * kSamples;
    sum += share;
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_LT(chi_square_excess(counts, expected), 5.5);
  EXPECT_EQ(cell->directions.pdf({0, -1, 0}), 0);
}

}  // namespace
}  // namespace microtrace
