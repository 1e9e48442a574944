#include <microtrace/framing.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr double kEdge = 0.9;

/// The extent of projected points in a picture whose edges are at -1 and 1. The projection uses the
/// standard library's trigonometry.
struct Extent {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;
  double nearest = 1e300;  ///< smallest depth of a point
};

Extent seen(const std::vector<DVec3>& points, const PerspectiveCamera& camera, ImageSize size) {
  const double half_height = std::tan(camera.vertical_fov / 2);
  const DVec3 forward = glm::normalize(camera.pose.direction);
  const DVec3 right = glm::normalize(glm::cross(forward, camera.pose.up));
  const DVec3 up = glm::cross(right, forward);
  Extent extent;
  for (const DVec3& p : points) {
    const DVec3 v = p - camera.pose.position;
    const double depth = glm::dot(v, forward);
    const double x = glm::dot(v, right) / depth / (half_height * size.width / size.height);
    const double y = glm::dot(v, up) / depth / half_height;
    extent.left = std::min(extent.left, x);
    extent.right = std::max(extent.right, x);
    extent.bottom = std::min(extent.bottom, y);
    extent.top = std::max(extent.top, y);
    extent.nearest = std::min(extent.nearest, depth);
  }
  return extent;
}

/// Checks that all points are inside the picture and fill one axis from edge to edge.
void expect_tight(const Extent& e, double tolerance = 1e-6) {
  const double limit = kEdge + tolerance;
  EXPECT_GT(e.nearest, 0);
  EXPECT_GE(e.left, -limit);
  EXPECT_LE(e.right, limit);
  EXPECT_GE(e.bottom, -limit);
  EXPECT_LE(e.top, limit);
  const double least = kEdge - tolerance;
  EXPECT_TRUE((e.left < -least && e.right > least) || (e.bottom < -least && e.top > least))
      << e.left << " " << e.right << " " << e.bottom << " " << e.top;
}

Scene framed_scene(const std::vector<Shape>& shapes) {
  Scene scene;
  for (const Shape& shape : shapes) scene.objects.push_back({.name = "", .shape = shape});
  return scene;
}

Scene cloud(const std::vector<Vec3>& points) {
  return framed_scene({Mesh{.positions = points, .triangles = {}}});
}

std::vector<DVec3> widened(const std::vector<Vec3>& points) {
  return {points.begin(), points.end()};
}

constexpr ImageSize kSizes[] = {{640, 480}, {1920, 1080}, {300, 900}, {1, 1}, {64, 65}};

TEST(Framing, RandomPointsFillOneAxis) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> angle(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10, 6 * angle(random));
    const DVec3 spread(std::abs(normal(random)), std::abs(normal(random)),
                       std::abs(normal(random)));
    const DVec3 offset = 10.0 * DVec3(normal(random), normal(random), normal(random));
    std::vector<Vec3> points(static_cast<std::size_t>(3 + i % 60));
    for (Vec3& p : points)
      p = Vec3(size * (offset + spread * DVec3(normal(random), normal(random), normal(random))));
    const ImageSize picture = kSizes[static_cast<std::size_t>(i) % std::size(kSizes)];
    const View view{.azimuth = 400 * angle(random), .elevation = 90 * angle(random)};
    const PerspectiveCamera camera = frame(cloud(points), view, picture);
    const Extent extent = seen(widened(points), camera, picture);
    // For deep and narrow clouds, the camera's minimum distance applies, so the picture is not
    // filled.
    DVec3 low(1e300), high(-1e300);
    for (const Vec3& p : points) {
      low = glm::min(low, DVec3(p));
      high = glm::max(high, DVec3(p));
    }
    const double gap = glm::length(high - low) / 64;
    EXPECT_GE(extent.nearest, gap * (1 - 1e-6));
    SCOPED_TRACE(i);
    if (extent.nearest > gap * (1 + 1e-6)) expect_tight(extent);
  }
}

TEST(Framing, AnyAngleIsFilled) {
  const std::vector<Vec3> points = {{-1, -2, -3}, {1, 0, 2}, {0, 3, 1}, {4, 1, 0}};
  const ImageSize size{640, 480};
  for (const double degrees : {1.0, 20.0, 45.0, 90.0, 150.0}) {
    const PerspectiveCamera camera = frame(cloud(points), {.vertical_fov = degrees}, size);
    EXPECT_NEAR(camera.vertical_fov, degrees * std::numbers::pi / 180, 1e-14);
    const Extent extent = seen(widened(points), camera, size);
    // For wide angles, the camera's minimum distance applies, so the picture is not filled.
    if (degrees < 100) expect_tight(extent);
    EXPECT_GT(extent.nearest, 0);
  }
}

TEST(Framing, OrbitsATarget) {
  Framing framing({.azimuth = 90, .elevation = 0}, {640, 480});
  EXPECT_EQ(framing.center(), DVec3(0));
  framing.add(cloud({{1, 2, 3}, {3, 8, -1}}));
  EXPECT_EQ(framing.center(), DVec3(2, 5, 1));
  const PerspectiveCamera camera = framing.camera_around({4, 5, 6}, 10);
  EXPECT_EQ(camera.pose.position, DVec3(14, 5, 6));
  EXPECT_EQ(camera.pose.direction, framing.camera().pose.direction);
}

TEST(Framing, MarginsOnTheOtherAxisAreEqual) {
  const std::vector<Vec3> wide = {{-100, 0, 0}, {100, 0, 0}, {0, 1, 0}, {0, 3, 0}};
  const ImageSize size{640, 480};
  const PerspectiveCamera camera = frame(cloud(wide), {.azimuth = 0, .elevation = 0}, size);
  const Extent extent = seen(widened(wide), camera, size);
  expect_tight(extent);
  EXPECT_NEAR(camera.pose.position.y, 1.5, 1e-12);
}

/// The difference of the two margins along the axis that is not filled, relative to the picture.
double imbalance(const Extent& e) {
  return std::max(std::abs(e.left + e.right), std::abs(e.bottom + e.top)) / 2;
}

// The far edge of a floor is smaller in the picture than its near edge.
TEST(Framing, FloorsAndWallsAreCentered) {
  const ImageSize size{640, 480};
  for (const std::vector<Vec3>& corners :
       std::vector<std::vector<Vec3>>{{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}},
                                      {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                                      {{0, 0, -4}, {1, 0, -4}, {1, 0, 4}, {0, 0, 4}},
                                      {{-1, 0, -1}, {1, 0, -1}, {1, 9, 1}, {-1, 9, 1}}}) {
    const Extent extent = seen(widened(corners), frame(cloud(corners), View{}, size), size);
    expect_tight(extent);
    EXPECT_LT(imbalance(extent), 0.005);
  }
}

TEST(Framing, RandomPointsAreCentered) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double sum = 0;
  constexpr int kCount = 1000;
  for (int i = 0; i < kCount; ++i) {
    const Vec3 spread(normal(random), normal(random), normal(random));
    std::vector<Vec3> points(8);
    for (Vec3& p : points) p = spread * Vec3(normal(random), normal(random), normal(random));
    const ImageSize size = kSizes[static_cast<std::size_t>(i) % std::size(kSizes)];
    const double value = imbalance(seen(widened(points), frame(cloud(points), View{}, size), size));
    EXPECT_LT(value, 0.07) << i;
    sum += value;
  }
  EXPECT_LT(sum / kCount, 0.002);
}

TEST(Framing, RoundShapesAreFramedByTheirOutlines) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const DVec3 center(3, -2, 5);
  // The same ball as three shapes, and as a cloud of points on its surface.
  const Sphere sphere{.center = center, .radius = 2};
  const Quadric quadric{.a = 1, .b = 1, .c = 1, .g = -6, .h = 4, .i = -10, .j = 9 + 4 + 25 - 4};
  const Quadric negative{.a = -2, .b = -2, .c = -2, .g = 12, .h = -8, .i = 20, .j = -68};
  std::vector<DVec3> ball;
  for (int i = 0; i < 400000; ++i) {
    ball.push_back(center +
                   2.0 * glm::normalize(DVec3(normal(random), normal(random), normal(random))));
  }
  const ImageSize size{640, 480};
  for (const Shape& shape : {Shape(sphere), Shape(quadric), Shape(negative)}) {
    const PerspectiveCamera camera = frame(framed_scene({shape}), View{}, size);
    expect_tight(seen(ball, camera, size), 1e-3);
    // The ball fills the height: the sine of half the subtended angle is radius / distance.
    const double half = std::atan(kEdge * std::tan(std::numbers::pi / 8));
    EXPECT_NEAR(glm::distance(camera.pose.position, center), 2 / std::sin(half), 1e-6);
  }
  // The quadric x^2 + xy + y^2 + 4 z^2 = 1 translated to `middle`. Relative to `middle`, its points
  // satisfy p^T A p = 1.
  const Quadric tilted{.a = 1, .b = 1, .c = 4, .d = 1, .g = -4, .h = 1, .i = -40, .j = 105.5F};
  const glm::dmat3 matrix(1, 0.5, 0, 0.5, 1, 0, 0, 0, 4);
  const DVec3 middle(3, -2, 5);
  std::vector<DVec3> skin;
  for (int i = 0; i < 400000; ++i) {
    const DVec3 d(normal(random), normal(random), normal(random));
    const double value = glm::dot(middle, matrix * middle) - tilted.j;
    skin.push_back(middle + d * std::sqrt(value / glm::dot(d, matrix * d)));
  }
  expect_tight(seen(skin, frame(framed_scene({tilted}), View{}, size), size), 2e-3);

  const Disc disc{.center = center, .normal = {1, 2, -2}, .radius = 3};
  const DVec3 u = glm::normalize(DVec3(2, -1, 0));
  const DVec3 v = glm::normalize(glm::cross(DVec3(disc.normal), u));
  std::vector<DVec3> rim;
  for (int i = 0; i < 10000; ++i) {
    rim.push_back(center + 3 * std::cos(i * 1e-3) * u + 3 * std::sin(i * 1e-3) * v);
  }
  expect_tight(seen(rim, frame(framed_scene({disc}), View{}, size), size), 1e-5);
}

TEST(Framing, NamedViewsLookFromTheirSides) {
  const Scene scene = cloud({{-1, -1, -1}, {1, 1, 1}, {-1, 1, -1}});
  struct Case {
    View view;
    DVec3 direction, up;
  };
  for (const Case& c :
       {Case{{0, 0}, {0, 0, -1}, {0, 1, 0}}, Case{{90, 0}, {-1, 0, 0}, {0, 1, 0}},
        Case{{180, 0}, {0, 0, 1}, {0, 1, 0}}, Case{{270, 0}, {1, 0, 0}, {0, 1, 0}},
        Case{{0, 90}, {0, -1, 0}, {0, 0, -1}}, Case{{0, -90}, {0, 1, 0}, {0, 0, 1}}}) {
    const PerspectiveCamera camera = frame(scene, c.view, {640, 480});
    EXPECT_EQ(camera.pose.direction, c.direction);
    EXPECT_EQ(camera.pose.up, c.up);
    EXPECT_LT(glm::dot(camera.pose.position, c.direction), -1);
  }
}

TEST(Framing, NeedleAlongTheViewKeepsItsDistance) {
  const std::vector<Vec3> needle = {{0, 0, 9}, {0, 0, 0}, {0, 0, -9}};
  const PerspectiveCamera camera = frame(cloud(needle), {.azimuth = 0, .elevation = 0}, {640, 480});
  EXPECT_NEAR(seen(widened(needle), camera, {640, 480}).nearest, 18.0 / 64, 1e-12);
}

TEST(Framing, PointsAndEmptyScenesAreSeenFromDistanceOne) {
  const PerspectiveCamera point = frame(cloud({Vec3(5), Vec3(5)}), View{}, {640, 480});
  EXPECT_NEAR(glm::distance(point.pose.position, DVec3(5)), 1, 1e-12);
  const PerspectiveCamera nothing = frame(Scene{}, View{}, {640, 480});
  EXPECT_NEAR(glm::length(nothing.pose.position), 1, 1e-12);
}

TEST(Framing, UnboundedAndNonFiniteShapesAreIgnored) {
  const std::vector<Vec3> points = {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const ImageSize size{640, 480};
  const DVec3 expected = frame(cloud(points), View{}, size).pose.position;
  std::vector<Vec3> more = points;
  more.insert(more.end(), {Vec3(INFINITY), Vec3(NAN, 100, 0)});
  Scene scene = cloud(more);
  for (const Shape& shape : {Shape(Plane{{100, 0, 0}, {1, 0, 0}}), Shape(Sphere{{50, 0, 0}, -1}),
                             Shape(Sphere{{NAN, 0, 0}, 1}), Shape(Disc{{50, 0, 0}, {0, 0, 0}, 1}),
                             Shape(Quadric{.a = 1, .b = 1, .j = -100}),          // a cylinder
                             Shape(Quadric{.a = 1, .b = 1, .c = -1, .j = -9}),   // a hyperboloid
                             Shape(Quadric{.a = 1, .b = 1, .c = 1, .j = 9})}) {  // empty
    scene.objects.push_back({.name = "", .shape = shape});
  }
  EXPECT_EQ(frame(scene, View{}, size).pose.position, expected);
}

TEST(Framing, CombinesScenes) {
  const std::vector<Vec3> a = {{0, 0, 0}, {1, 2, 3}}, b = {{5, -6, 7}, {0, 9, 0}};
  const ImageSize size{300, 200};
  Framing framing(View{}, size);
  framing.add(cloud(a));
  framing.add(cloud(b));
  const DVec3 both = frame(cloud({a[0], a[1], b[0], b[1]}), View{}, size).pose.position;
  EXPECT_EQ(framing.camera().pose.position, both);
}

TEST(Framing, FarAwayAndHuge) {
  std::vector<Vec3> points = {{-1, -1, -1}, {1, 1, 1}, {-1, 1, 1}};
  for (Vec3& p : points) p += Vec3(1e6F, -2e6F, 3e6F);
  expect_tight(seen(widened(points), frame(cloud(points), View{}, {640, 480}), {640, 480}));
  for (Vec3& p : points) p *= 1e30F;
  expect_tight(seen(widened(points), frame(cloud(points), View{}, {640, 480}), {640, 480}));
}

TEST(DefaultCamera, IsTheFirstElseFramed) {
  Scene scene = cloud({Vec3(0), Vec3(1)});
  EXPECT_EQ(std::get<PerspectiveCamera>(default_camera(scene, {640, 480})).pose.position,
            frame(scene, View{}, {640, 480}).pose.position);
  scene.cameras.push_back({.name = "first", .camera = EnvironmentCamera{}});
  EXPECT_TRUE(std::holds_alternative<EnvironmentCamera>(default_camera(scene, {640, 480})));
}

}  // namespace
}  // namespace microtrace
