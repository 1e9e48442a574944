#include "scene/math/trigonometry.hpp"

#include <microtrace/camera.hpp>

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kSize{.width = 640, .height = 480};

void expect_near(const Vec3& actual, const DVec3& expected, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(actual[k], expected[k], tolerance) << "component " << k;
}

PerspectiveCamera first_camera() {
  return {.pose = {.position = {0, 0, 10}}, .vertical_fov = radians_from_degrees(60)};
}

TEST(PerspectiveCamera, GoldenCornerRays) {
  const RayGenerator ray(first_camera(), kSize);
  expect_near(ray(0.5, 479.5).d, {-0.5543, -0.415508, -0.721183}, 1e-6);
  expect_near(ray(639.5, 479.5).d, {0.5543, -0.415508, -0.721183}, 1e-6);
  expect_near(ray(0.5, 0.5).d, {-0.5543, 0.415508, -0.721183}, 1e-6);
  expect_near(ray(639.5, 0.5).d, {0.5543, 0.415508, -0.721183}, 1e-6);
  EXPECT_EQ(ray(0.5, 0.5).o, Vec3(0, 0, 10));
}

TEST(PerspectiveCamera, MiddleOfThePictureIsTheViewingDirection) {
  const RayGenerator ray(
      {PerspectiveCamera{.pose = {.position = {-8, 3, 8}, .direction = {1, -0.1, -1}},
                         .vertical_fov = radians_from_degrees(45)}},
      kSize);
  expect_near(ray(320, 240).d, glm::normalize(DVec3(1, -0.1, -1)), 1e-7);
}

TEST(PerspectiveCamera, FractionalCoordinatesFollowTheDerivation) {
  // d ~ f + x (2 px / W - 1) (W / H) tan + u (1 - 2 py / H) tan, computed by hand for the first
  // camera.
  const double tangent = 1 / std::numbers::sqrt3;
  const DVec3 expected = glm::normalize(
      DVec3((2 * 128.5 / 640 - 1) * (640.0 / 480) * tangent, (1 - 2 * 5.5 / 480) * tangent, -1));
  expect_near(RayGenerator(first_camera(), kSize)(128.5, 5.5).d, expected, 1e-7);
}

TEST(PerspectiveCamera, FocusAndLengthsHaveNoEffect) {
  PerspectiveCamera other = first_camera();
  other.focus = 7.3;
  other.pose.direction *= 8.0;
  other.pose.up = DVec3(0, 4, 2);
  const RayGenerator a(first_camera(), kSize), b(other, kSize);
  for (double x : {0.5, 17.25, 639.5}) {
    const Vec3 d = a(x, 100).d, e = b(x, 100).d;
    expect_near(d, DVec3(e), 1e-7);
  }
}

TEST(PerspectiveCamera, DirectionsHaveUnitLength) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(0, 640), y(0, 480);
  const RayGenerator ray(first_camera(), kSize);
  for (int i = 0; i < 1000; ++i)
    EXPECT_NEAR(glm::length(DVec3(ray(x(random), y(random)).d)), 1, 1e-7);
}

TEST(PerspectiveCamera, VerticalAngleSpansThePicture) {
  const RayGenerator ray(first_camera(), {.width = 100, .height = 300});
  const DVec3 top = ray(50, 0).d, bottom = ray(50, 300).d;
  EXPECT_NEAR(std::acos(glm::dot(top, bottom)), std::numbers::pi / 3, 1e-6);
}

TEST(PerspectiveCamera, WindowWithAspectRatioIsFitted) {
  PerspectiveCamera camera = first_camera();
  camera.aspect_ratio = 2;
  const double half = std::tan(std::numbers::pi / 6);
  // If the picture is wider than the window, the height fits; if narrower, the width.
  const DVec3 wide = RayGenerator(camera, {.width = 400, .height = 100})(200, 0).d;
  EXPECT_NEAR(wide.y / -wide.z, half, 1e-6);
  const DVec3 narrow = RayGenerator(camera, {.width = 100, .height = 100})(0, 50).d;
  EXPECT_NEAR(narrow.x / narrow.z, 2 * half, 1e-6);
}

TEST(PerspectiveCamera, DepthRangeIsMeasuredAlongTheViewingDirection) {
  PerspectiveCamera camera = first_camera();
  camera.depth = {.near = 2, .far = 5};
  const Ray ray = RayGenerator(camera, kSize)(0.5, 0.5);
  EXPECT_NEAR(ray.t_min * -ray.d.z, 2, 1e-6);
  EXPECT_NEAR(ray.t_max * -ray.d.z, 5, 1e-6);
  EXPECT_EQ(RayGenerator(first_camera(), kSize)(0.5, 0.5).t_min,
            std::numeric_limits<float>::denorm_min());
}

TEST(OrthographicCamera, ParallelRaysAPixelApart) {
  const OrthographicCamera camera{.pose = {.position = {1, 2, 3}}, .height = 48};
  const RayGenerator ray(camera, kSize);
  EXPECT_EQ(ray(320, 240).o, Vec3(1, 2, 3));
  expect_near(ray(0, 0).o, {1 - 32, 2 + 24, 3}, 1e-5);
  expect_near(ray(321, 240).o, {1.1, 2, 3}, 1e-6);
  EXPECT_EQ(ray(5, 7).d, Vec3(0, 0, -1));
}

TEST(EnvironmentCamera, LongitudeAcrossLatitudeDown) {
  const RayGenerator ray(EnvironmentCamera{}, {.width = 360, .height = 180});
  expect_near(ray(180, 90).d, {0, 0, -1}, 1e-7);
  expect_near(ray(270, 90).d, {1, 0, 0}, 1e-7);
  expect_near(ray(90, 90).d, {-1, 0, 0}, 1e-7);
  expect_near(ray(0, 90).d, {0, 0, 1}, 1e-7);
  expect_near(ray(12, 0).d, {0, 1, 0}, 1e-7);
  expect_near(ray(12, 180).d, {0, -1, 0}, 1e-7);
  expect_near(ray(180, 45).d, {0, std::numbers::sqrt2 / 2, -std::numbers::sqrt2 / 2}, 1e-7);
}

TEST(RayGenerator, DifferentialsAreTheStepsToNeighboringPixels) {
  const Pose pose{.position = {1, 2, 3}, .direction = {3, -1, 2}, .up = {0.2, 1, 0}};
  const Camera cameras[] = {PerspectiveCamera{.pose = pose, .vertical_fov = 1.2},
                            OrthographicCamera{.pose = pose, .height = 7},
                            EnvironmentCamera{.pose = pose}};
  for (const Camera& camera : cameras) {
    const RayGenerator ray(camera, kSize);
    const Ray here = ray(100, 400);
    const RayDifferential step = ray.differential(here);
    // Float32 rays: a step of ten pixels in each direction, compared with a relative tolerance of
    // 1/1000.
    const Ray left = ray(90, 400), right = ray(110, 400), above = ray(100, 390),
              below = ray(100, 410);
    const auto compare = [&](const DVec3& a, const DVec3& b) {
      const double tolerance = 2e-3 * glm::length(a) + 1e-6;
      EXPECT_LT(std::min(glm::length(a - b), glm::length(a + b)), tolerance);
    };
    compare(step.o_dx, DVec3(right.o - left.o) / 20.0);
    compare(step.o_dy, DVec3(below.o - above.o) / 20.0);
    compare(step.d_dx, DVec3(right.d - left.d) / 20.0);
    compare(step.d_dy, DVec3(below.d - above.d) / 20.0);
  }
}

}  // namespace
}  // namespace microtrace
