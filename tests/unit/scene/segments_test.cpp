#include <microtrace/render.hpp>
#include <microtrace/segments.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

namespace microtrace {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Pixel = std::pair<int, int>;
using Segment = std::array<std::uint32_t, 2>;

constexpr ImageSize kSegmentSize{.width = 60, .height = 40};

/// A camera for which a world unit is a pixel and (0, 0) is the picture's lower left corner.
const Camera kPixels = OrthographicCamera{.pose = {.position = {30, 20, 100}}, .height = 40};
const Camera kPerspective =
    PerspectiveCamera{.pose = {.position = {0, 0, 5}}, .vertical_fov = 1, .depth = {.near = 0.1}};
const Camera kEnvironment = EnvironmentCamera{};

Scene scene_of(std::vector<Vec3> positions, std::vector<Segment> segments) {
  Scene scene;
  scene.objects.push_back(
      {.name = "lines",
       .shape = Mesh{.positions = std::move(positions), .triangles = {}, .segments = segments}});
  return scene;
}

/// Returns the covered pixels, as column from the left and row from the bottom.
std::vector<Pixel> drawn_segments(const Scene& scene, const Camera& camera,
                                  ImageSize size = kSegmentSize) {
  Film film = render(scene, camera, size, {.threads = 1});
  std::vector<Pixel> result;
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (std::uint32_t x = 0; x < size.width; ++x) {
      if (film.at(x, size.height - 1 - y) != Vec3(0)) result.emplace_back(x, y);
    }
  }
  return result;
}

std::vector<Pixel> line(const Vec3& a, const Vec3& b, const Camera& camera = kPixels) {
  return drawn_segments(scene_of({a, b}, {{0, 1}}), camera);
}

/// Returns true if the pixels are 8-connected.
bool is_connected(const std::vector<Pixel>& pixels) {
  if (pixels.empty()) return false;
  std::vector<bool> reached(pixels.size());
  std::queue<std::size_t> open;
  open.push(0);
  reached[0] = true;
  std::size_t count = 0;
  for (; !open.empty(); open.pop(), ++count) {
    const auto [x, y] = pixels[open.front()];
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (reached[i] || std::abs(pixels[i].first - x) > 1 || std::abs(pixels[i].second - y) > 1)
        continue;
      reached[i] = true;
      open.push(i);
    }
  }
  return count == pixels.size();
}

TEST(Segments, PointsCoverTheirPixel) {
  for (const float x : {7.0F, 7.25F, 7.5F, 7.75F}) {
    for (const float y : {9.0F, 9.25F, 9.5F, 9.75F}) {
      const Scene scene = scene_of({Vec3(x, y, 0)}, {{0, 0}});
      // A point on the border between two pixels covers the right or the lower one.
      const Pixel expected(7, y == 9 ? 8 : 9);
      EXPECT_THAT(drawn_segments(scene, kPixels), ElementsAre(expected)) << x << " " << y;
    }
  }
}

TEST(Segments, AxisAlignedLinesAreOnePixelWide) {
  for (const float at : {12.0F, 12.3F, 12.5F, 12.8F}) {
    const std::vector<Pixel> level = line(Vec3(10.5, at, 0), Vec3(40.5, at, 0));
    EXPECT_EQ(level.size(), 31U) << at;
    EXPECT_EQ(level.front().second, level.back().second);
    const std::vector<Pixel> upright = line(Vec3(at, 10.5, 0), Vec3(at, 30.5, 0));
    EXPECT_EQ(upright.size(), 21U) << at;
    EXPECT_EQ(upright.front().first, upright.back().first);
  }
}

TEST(Segments, LinesInAllDirectionsAreConnectedAndThin) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> x(1, 59), y(1, 39);
  for (int i = 0; i < 500; ++i) {
    const Vec3 a(x(random), y(random), 0), b(x(random), y(random), 0);
    const std::vector<Pixel> pixels = line(a, b);
    const Vec3 d = b - a;
    const float extent = std::max(std::abs(d.x), std::abs(d.y));
    const float length = std::sqrt(d.x * d.x + d.y * d.y);
    EXPECT_TRUE(is_connected(pixels)) << i;
    EXPECT_GE(static_cast<float>(pixels.size()), std::floor(extent)) << i;
    EXPECT_LE(static_cast<float>(pixels.size()), 1.25F * length + 5) << i;
  }
}

TEST(Segments, ShortLinesNeverVanish) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> x(1, 59), y(1, 39), step(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 a(x(random), y(random), 0);
    const std::vector<Pixel> pixels = line(a, a + Vec3(step(random), step(random), step(random)));
    EXPECT_TRUE(is_connected(pixels)) << i;
    EXPECT_LE(pixels.size(), 4U) << i;
  }
}

TEST(Segments, PerspectiveLinesAreConnectedNearAndFar) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> x(-2, 2), z(-50, 4.5F);
  for (int i = 0; i < 300; ++i) {
    const Vec3 a(x(random) / 2, x(random) / 2, 0);
    const Vec3 b(x(random), x(random), z(random));
    const std::vector<Pixel> pixels = line(a, b, kPerspective);
    EXPECT_TRUE(is_connected(pixels)) << i;
    EXPECT_LE(pixels.size(), 120U) << i;
  }
}

TEST(Segments, LinesAreClippedAtTheCamera) {
  // The line leads from the picture's center to its right edge and continues behind the camera.
  const std::vector<Pixel> pixels = line(Vec3(0, 0, 0), Vec3(6, 0, 10), kPerspective);
  EXPECT_TRUE(is_connected(pixels));
  EXPECT_EQ(pixels.front().first, 30);
  EXPECT_EQ(pixels.back().first, 59);
  EXPECT_EQ(pixels.size(), 30U);
  EXPECT_THAT(line(Vec3(-3, 0, 6), Vec3(3, 0, 6), kPerspective), IsEmpty());
  EXPECT_THAT(line(Vec3(0, 0, 5), Vec3(0, 0, 5), kPerspective), IsEmpty());
  EXPECT_THAT(line(Vec3(-1, 3, 5), Vec3(2, 5, 0), kPerspective), IsEmpty());
}

TEST(Segments, EnvironmentCamerasSeeAllDirections) {
  std::mt19937 random(10);
  std::normal_distribution<float> normal;
  const auto anywhere = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = anywhere();
    const std::vector<Pixel> point = line(a, a, kEnvironment);
    EXPECT_FALSE(point.empty()) << i;
    const Vec3 b = anywhere();
    EXPECT_GE(line(a, b, kEnvironment).size(), 1U) << i;
  }
  // The line spans a quarter of the horizon, from straight ahead to the right and slightly above
  // the camera.
  const std::vector<Pixel> quarter =
      drawn_segments(scene_of({Vec3(0, 0.05F, -1), Vec3(1, 0.05F, 0)}, {{0, 1}}), kEnvironment,
                     {.width = 60, .height = 30});
  EXPECT_TRUE(is_connected(quarter));
  EXPECT_NEAR(static_cast<double>(quarter.size()), 16, 2);
}

TEST(Segments, DistortedLinesAreConnectedAndVisible) {
  CalibratedCamera camera{.pose = {.position = {0, 0, 5}},
                          .image = kSegmentSize,
                          .fx = 36,
                          .fy = 38,
                          .cx = 27,
                          .cy = 21,
                          .distortion = RationalDistortion{.k1 = -0.25, .p1 = 0.01}};
  const Camera cameras[] = {camera,
                            [camera]() mutable {
                              camera.distortion = RationalDistortion{.k1 = 0.6, .k2 = 0.5};
                              return camera;
                            }(),
                            [camera]() mutable {
                              camera.fx = camera.fy = 14;
                              camera.distortion = FisheyeDistortion{.k1 = 0.02};
                              return camera;
                            }()};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> x(-3, 3), z(-8, 4);
  for (const Camera& any : cameras) {
    const RayGenerator rays(any, kSegmentSize);
    const auto shown = [&](const Vec3& p) {
      const auto pixel = rays.project(DVec3(p));
      const DVec2 size(kSegmentSize.width, kSegmentSize.height);
      return pixel && pixel->x > 1 && pixel->y > 1 && pixel->x < size.x - 1 && pixel->y < size.y - 1
                 ? pixel
                 : std::nullopt;
    };
    for (int i = 0; i < 200; ++i) {
      const Vec3 a(x(random), x(random), z(random)), b(x(random), x(random), z(random));
      const std::vector<Pixel> point = line(a, a, any);
      EXPECT_EQ(shown(a) ? point.empty() : false, false) << i;
      const std::vector<Pixel> pixels = line(a, b, any);
      const auto p = shown(a), q = shown(b);
      if (!p || !q) continue;
      EXPECT_TRUE(is_connected(pixels)) << i;
      for (const DVec2& end : {*p, *q}) {
        const auto reaches = [&](const Pixel& pixel) {
          const DVec2 center(pixel.first + 0.5, kSegmentSize.height - 0.5 - pixel.second);
          return std::abs(center.x - end.x) <= 1.5 && std::abs(center.y - end.y) <= 1.5;
        };
        EXPECT_TRUE(std::ranges::any_of(pixels, reaches)) << any.index() << " " << i;
      }
    }
  }
}

TEST(Segments, OccludeAndAreOccluded) {
  Scene scene = scene_of({Vec3(5, 20.4F, 0), Vec3(55, 20.4F, 0)}, {{0, 1}});
  scene.objects.push_back({.name = "wall", .shape = Triangle{{20, 0, 1}, {40, 0, 1}, {30, 90, 1}}});
  scene.materials.push_back({.base_color = Vec4(1, 0, 0, 1)});
  scene.objects[0].material = 0;
  Film film = render(scene, kPixels, kSegmentSize, {.threads = 1});
  EXPECT_EQ(film.at(10, 19), Vec3(1, 0, 0));
  EXPECT_EQ(film.at(30, 19), Vec3(1));
  scene.objects[1].shape = Triangle{{20, 0, -1}, {40, 0, -1}, {30, 90, -1}};
  film = render(scene, kPixels, kSegmentSize, {.threads = 1});
  EXPECT_EQ(film.at(30, 19), Vec3(1, 0, 0));
  EXPECT_EQ(film.at(30, 18), Vec3(1));
}

TEST(Segments, EachTakesTwoTriangles) {
  Scene scene;
  scene.objects.push_back(
      {.name = "both",
       .shape = Mesh{.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.01F, 0, 9)},
                     .triangles = {{0, 1, 2}},
                     .uv_sets = {{Vec2(0), Vec2(1), Vec2(2), Vec2(4)}},
                     .colors = {Vec4(0), Vec4(1), Vec4(0), Vec4(1)},
                     .segments = {{3, 3}, {0, 1}, {0, 3}}}});
  ASSERT_TRUE(has_segments(scene));
  widen_segments(scene, kPerspective, kSegmentSize);
  EXPECT_FALSE(has_segments(scene));
  const Mesh& mesh = std::get<Mesh>(scene.objects[0].shape);
  ASSERT_EQ(mesh.triangles.size(), 7U);
  ASSERT_EQ(mesh.positions.size(), 16U);
  EXPECT_EQ(mesh.colors.size(), 16U);
  EXPECT_EQ(mesh.uv_sets[0].size(), 16U);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_TRUE(std::isnan(mesh.positions[4].x));  // behind the camera
  EXPECT_EQ(mesh.uv_sets[0][8], Vec2(0));
  EXPECT_EQ(mesh.uv_sets[0][10], Vec2(1));
  // The near plane clips the last line at 4.9 / 9 of its length.
  EXPECT_NEAR(mesh.uv_sets[0][15].x, 4 * 4.9 / 9, 1e-5);
  EXPECT_NEAR(mesh.colors[15].w, 4.9 / 9, 1e-5);
}

TEST(Segments, FaceTheCamera) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> x(-2, 2);
  for (const Camera& camera : {kPerspective, kEnvironment}) {
    const DVec3 eye = std::visit([](const auto& c) { return c.pose.position; }, camera);
    for (int i = 0; i < 100; ++i) {
      Scene scene =
          scene_of({Vec3(x(random), x(random), x(random)), Vec3(x(random), x(random), x(random))},
                   {{0, 1}, {0, 0}});
      widen_segments(scene, camera, kSegmentSize);
      const Mesh& mesh = std::get<Mesh>(scene.objects[0].shape);
      for (const auto& [ia, ib, ic] : mesh.triangles) {
        const DVec3 a(mesh.positions[ia]), b(mesh.positions[ib]), c(mesh.positions[ic]);
        if (std::isnan(a.x)) continue;
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), eye - a), 0) << i;
      }
    }
  }
}

}  // namespace
}  // namespace microtrace
