#include "scene/math/trigonometry.hpp"

#include <microtrace/camera.hpp>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kCameraSize{.width = 640, .height = 480};

void expect_near(const Vec3& actual, const DVec3& expected, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(actual[k], expected[k], tolerance) << "component " << k;
}

PerspectiveCamera first_camera() {
  return {.pose = {.position = {0, 0, 10}}, .vertical_fov = radians_from_degrees(60)};
}

TEST(PerspectiveCamera, GoldenCornerRays) {
  const RayGenerator ray(first_camera(), kCameraSize);
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
      kCameraSize);
  expect_near(ray(320, 240).d, glm::normalize(DVec3(1, -0.1, -1)), 1e-7);
}

TEST(PerspectiveCamera, FractionalCoordinatesFollowTheDerivation) {
  // d ~ f + x (2 px / W - 1) (W / H) tan + u (1 - 2 py / H) tan, evaluated by hand for
  // first_camera().
  const double tangent = 1 / std::numbers::sqrt3;
  const DVec3 expected = glm::normalize(
      DVec3((2 * 128.5 / 640 - 1) * (640.0 / 480) * tangent, (1 - 2 * 5.5 / 480) * tangent, -1));
  expect_near(RayGenerator(first_camera(), kCameraSize)(128.5, 5.5).d, expected, 1e-7);
}

TEST(PerspectiveCamera, FocusAndLengthsHaveNoEffect) {
  PerspectiveCamera other = first_camera();
  other.focus = 7.3;
  other.pose.direction *= 8.0;
  other.pose.up = DVec3(0, 4, 2);
  const RayGenerator a(first_camera(), kCameraSize), b(other, kCameraSize);
  for (double x : {0.5, 17.25, 639.5}) {
    const Vec3 d = a(x, 100).d, e = b(x, 100).d;
    expect_near(d, DVec3(e), 1e-7);
  }
}

TEST(PerspectiveCamera, DirectionsHaveUnitLength) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(0, 640), y(0, 480);
  const RayGenerator ray(first_camera(), kCameraSize);
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
  // If the picture is wider than the window, their heights match. If it is narrower, their widths
  // match.
  const DVec3 wide = RayGenerator(camera, {.width = 400, .height = 100})(200, 0).d;
  EXPECT_NEAR(wide.y / -wide.z, half, 1e-6);
  const DVec3 narrow = RayGenerator(camera, {.width = 100, .height = 100})(0, 50).d;
  EXPECT_NEAR(narrow.x / narrow.z, 2 * half, 1e-6);
}

TEST(PerspectiveCamera, DepthRangeIsMeasuredAlongTheViewingDirection) {
  PerspectiveCamera camera = first_camera();
  camera.depth = {.near = 2, .far = 5};
  const Ray ray = RayGenerator(camera, kCameraSize)(0.5, 0.5);
  EXPECT_NEAR(ray.t_min * -ray.d.z, 2, 1e-6);
  EXPECT_NEAR(ray.t_max * -ray.d.z, 5, 1e-6);
  EXPECT_EQ(RayGenerator(first_camera(), kCameraSize)(0.5, 0.5).t_min,
            std::numeric_limits<float>::denorm_min());
}

TEST(OrthographicCamera, ParallelRaysAPixelApart) {
  const OrthographicCamera camera{.pose = {.position = {1, 2, 3}}, .height = 48};
  const RayGenerator ray(camera, kCameraSize);
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

constexpr RationalDistortion kStrong{
    .k1 = -0.35, .k2 = 0.11, .p1 = 0.004, .p2 = -0.006, .k3 = 0.02};
constexpr RationalDistortion kRational{
    .k1 = 4.2, .k2 = 1.3, .p1 = -0.001, .p2 = 0.0007, .k3 = 0.05, .k4 = 4.6, .k5 = 2.1, .k6 = 0.3};
constexpr FisheyeDistortion kWide{.k1 = 0.03, .k2 = -0.008, .k3 = 0.001, .k4 = -0.0001};

/// Returns the direction with polar angle `from_axis` and azimuth `around`, in degrees, in OpenCV's
/// camera space: x right, y down, z forward.
DVec3 at_angles(double from_axis, double around) {
  return {sin_degrees(from_axis) * cos_degrees(around),
          sin_degrees(from_axis) * sin_degrees(around), cos_degrees(from_axis)};
}

/// Converts a direction in world space to OpenCV's camera space, for a camera with the default
/// pose.
DVec3 in_opencv(const Vec3& d) {
  return {d.x, -d.y, -d.z};
}

TEST(CalibratedCamera, GoldenRaysWithoutDistortion) {
  // The direction through (x, y) is ((x - 0.5 - cx) / fx, (y - 0.5 - cy) / fy, 1).
  const RayGenerator ray(CalibratedCamera{.fx = 500, .fy = 400, .cx = 300, .cy = 200}, kCameraSize);
  expect_near(ray(300.5, 200.5).d, {0, 0, -1}, 1e-7);
  expect_near(ray(800.5, 200.5).d, glm::normalize(DVec3(1, 0, -1)), 1e-7);
  expect_near(ray(50.5, 300.5).d, glm::normalize(DVec3(-0.5, -0.25, -1)), 1e-7);
}

TEST(CalibratedCamera, GoldenRaysOfLenses) {
  // Computed by hand: the point (0.5, 0.25) of the plane at depth 1 has r^2 = 0.3125, which gives
  // the factor 1 + 0.1 r^2 - 0.2 r^4 = 1.01171875.
  const double factor = 1.01171875;
  CalibratedCamera camera{
      .fx = 400, .fy = 400, .distortion = RationalDistortion{.k1 = 0.1, .k2 = -0.2}};
  RayGenerator ray(camera, kCameraSize);
  expect_near(ray(320 + 200 * factor, 240 + 100 * factor).d, glm::normalize(DVec3(0.5, -0.25, -1)),
              1e-7);
  // Tangential distortion: x' = 0.5 + 2 p1 x y + p2 (r^2 + 2 x^2),
  // y' = 0.25 + p1 (r^2 + 2 y^2) + 2 p2 x y.
  camera.distortion = RationalDistortion{.p1 = 0.08, .p2 = 0.16};
  ray = RayGenerator(camera, kCameraSize);
  const double x = 0.5 + 0.08 * 0.25 + 0.16 * 0.8125, y = 0.25 + 0.08 * 0.4375 + 0.16 * 0.25;
  expect_near(ray(320 + 400 * x, 240 + 400 * y).d, glm::normalize(DVec3(0.5, -0.25, -1)), 1e-7);
  // A fisheye lens sees a direction at 120 degrees, which points backward.
  const double a = std::numbers::pi * 2 / 3;
  camera.distortion = FisheyeDistortion{.k1 = 0.01};
  ray = RayGenerator(camera, kCameraSize);
  expect_near(ray(320, 240 - 400 * (a + 0.01 * a * a * a)).d, {0, std::sqrt(0.75), 0.5}, 2e-7);
}

TEST(CalibratedCamera, WithoutDistortionIsAPerspectiveCamera) {
  const Pose pose{.position = {1, 2, 3}, .direction = {3, -1, 2}, .up = {0.2, 1, 0}};
  const PerspectiveCamera perspective{
      .pose = pose, .vertical_fov = 1, .depth = {.near = 0.5, .far = 9}};
  const double f = 240 / tan_radians(0.5);
  const RayGenerator a(perspective, kCameraSize),
      b(CalibratedCamera{.pose = pose, .fx = f, .fy = f, .depth = perspective.depth}, kCameraSize);
  for (double y = -3; y < 490; y += 17.3) {
    for (double x = -3; x < 650; x += 13.7) {
      const Ray r = a(x, y), s = b(x, y);
      EXPECT_EQ(r.o, s.o);
      expect_near(s.d, DVec3(r.d), 6e-8);  // the tolerance covers rounding to float32
      EXPECT_FLOAT_EQ(r.t_min, s.t_min);
      EXPECT_FLOAT_EQ(r.t_max, s.t_max);
    }
  }
}

/// Distortions with and without difficult features: folds inside the picture, poles, tangential
/// terms and functions that are not monotonic.
std::vector<Distortion> all_distortions() {
  return {RationalDistortion{},
          kStrong,
          kRational,
          kWide,
          RationalDistortion{.k1 = -0.6},
          RationalDistortion{.k1 = 0.9, .k2 = 2},
          RationalDistortion{.k1 = -0.3, .k2 = 0.2, .p1 = 0.05, .p2 = -0.08},
          RationalDistortion{.p1 = 0.02, .p2 = 0.01},
          RationalDistortion{.k4 = -0.8},
          RationalDistortion{.k1 = 12, .k2 = -40, .k3 = 160, .k4 = 11.5, .k5 = -36, .k6 = 150},
          RationalDistortion{.k4 = 0.4, .k5 = 0.3, .k6 = 0.1},
          FisheyeDistortion{},
          FisheyeDistortion{.k1 = -0.2},
          FisheyeDistortion{.k1 = 0.1, .k2 = 0.5, .k3 = -0.6, .k4 = 0.2},
          FisheyeDistortion{.k1 = -0.05, .k2 = 0.01, .k3 = -0.003, .k4 = 0.0004}};
}

TEST(CalibratedCamera, ProjectsRaysToTheirPixels) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(0, 180), around(0, 360);
  for (const Distortion& distortion : all_distortions()) {
    const bool fisheye = std::holds_alternative<FisheyeDistortion>(distortion);
    SCOPED_TRACE(testing::PrintToString(distortion.index()));
    const RayGenerator rays(CalibratedCamera{.fx = 300, .fy = 250, .distortion = distortion},
                            kCameraSize);
    int seen = 0;
    for (int i = 0; i < 2000; ++i) {
      // If a direction projects to a pixel position, the ray through that position must have this
      // direction.
      const DVec3 d = at_angles(fisheye ? angle(random) : angle(random) / 2, around(random));
      const auto pixel = rays.project({d.x, -d.y, -d.z});
      if (!pixel) continue;
      ++seen;
      const Ray ray = rays(pixel->x, pixel->y);
      ASSERT_GT(ray.t_max, 0) << d.x << " " << d.y << " " << d.z;
      // Near a fold, an error in the pixel position causes a direction error of about its square
      // root.
      EXPECT_LT(glm::length(in_opencv(ray.d) - d), 1e-6) << d.x << " " << d.y << " " << d.z;
    }
    EXPECT_GT(seen, 300);
    int shown = 0;
    for (double y = 0.5; y < 480; y += 8) {
      for (double x = 0.5; x < 640; x += 8) {
        const Ray ray = rays(x, y);
        if (ray.t_max < 0) {
          EXPECT_LT(ray.t_max, ray.t_min);
          continue;
        }
        ++shown;
        EXPECT_NEAR(glm::length(DVec3(ray.d)), 1, 1e-7);
        const auto pixel = rays.project(DVec3(ray.d));
        // Rounding may move the ray's direction beyond the edge of the picture.
        if (pixel) {
          EXPECT_LT(glm::length(*pixel - DVec2(x, y)), 2e-4) << x << " " << y;
        }
      }
    }
    EXPECT_GT(shown, 500);
  }
}

TEST(CalibratedCamera, MirroredLensesHaveMirroredRays) {
  RationalDistortion mirrored = kStrong;
  mirrored.p2 = -mirrored.p2;
  const RayGenerator a(CalibratedCamera{.cx = 300.25, .distortion = kStrong}, kCameraSize),
      b(CalibratedCamera{.cx = 639 - 300.25, .distortion = mirrored}, kCameraSize);
  for (double y = 0.5; y < 480; y += 13) {
    for (double x = 0.5; x < 640; x += 13) {
      const Vec3 d = a(x, y).d, e = b(640 - x, y).d;
      expect_near({-e.x, e.y, e.z}, DVec3(d), 6e-8);
    }
  }
}

TEST(CalibratedCamera, OtherSizesScaleThePicture) {
  for (const Distortion& distortion : {Distortion(kStrong), Distortion(kWide), Distortion()}) {
    const CalibratedCamera camera{
        .fx = 310, .fy = 290, .cx = 311, .cy = 252, .distortion = distortion};
    const RayGenerator whole(camera, kCameraSize), half(camera, {.width = 320, .height = 240}),
        squeezed(camera, {.width = 160, .height = 960});
    for (double y = 0; y <= 480; y += 48) {
      for (double x = 0; x <= 640; x += 64) {
        const DVec3 d(whole(x, y).d);
        expect_near(half(x / 2, y / 2).d, d, 6e-8);
        expect_near(squeezed(x / 4, y * 2).d, d, 6e-8);
      }
    }
    const CameraModel model = squeezed.model();
    EXPECT_EQ(model.pixels_per_unit, DVec2(77.5, 580));
    EXPECT_EQ(model.center, DVec2(77.875, 505));
    EXPECT_EQ(model.distortion, distortion);
  }
}

TEST(CalibratedCamera, HasNoRaysWhereTheLensFolds) {
  // r - 0.3 r^3 has its maximum at r = sqrt(1 / 0.9). The distorted radius there is 2 / 3 of r.
  const double most = std::sqrt(1 / 0.9) * 2 / 3;
  const RayGenerator rays(CalibratedCamera{.distortion = RationalDistortion{.k1 = -0.3}},
                          kCameraSize);
  EXPECT_GT(rays(320 + 640 * (most - 1e-9), 240).t_max, 0);
  EXPECT_EQ(rays(320 + 640 * (most + 1e-9), 240).t_max, -1);
  EXPECT_EQ(rays(320, 240 - 640 * 1.1 * most).t_max, -1);
  EXPECT_FALSE(rays.project({1.06, 0, -1}));
  EXPECT_TRUE(rays.project({1.05, 0, -1}));
  EXPECT_FALSE(rays.project({0.1, 0.1, 1}));
  // a - 0.2 a^3 has its maximum at a = sqrt(1 / 0.6), which is 74 degrees.
  const RayGenerator fisheye(CalibratedCamera{.distortion = FisheyeDistortion{.k1 = -0.2}},
                             kCameraSize);
  const double farthest = std::sqrt(1 / 0.6) * 2 / 3;
  EXPECT_GT(fisheye(320 + 640 * (farthest - 1e-9), 240).t_max, 0);
  EXPECT_EQ(fisheye(320 + 640 * (farthest + 1e-9), 240).t_max, -1);
  // The equidistant fisheye shows all directions, and no rays exist beyond its image circle.
  const RayGenerator full(CalibratedCamera{.fx = 70, .fy = 70, .distortion = FisheyeDistortion{}},
                          kCameraSize);
  expect_near(full(320 + 70 * std::numbers::pi * (1 - 1e-9), 240).d, {0, 0, 1}, 1e-7);
  EXPECT_EQ(full(320 + 70 * 3.1416, 240).t_max, -1);
  EXPECT_EQ(full(0, 0).t_max, -1);
}

TEST(CalibratedCamera, DepthsOfFisheyeCamerasAreNegativeBehind) {
  const CalibratedCamera camera{
      .fx = 100, .fy = 100, .distortion = FisheyeDistortion{}, .depth = {.near = 2, .far = 5}};
  const RayGenerator rays(camera, kCameraSize);
  EXPECT_NEAR(rays.depth({1, 0, 2}), -2, 1e-15);
  const Ray ray = rays(320 + 50 * std::numbers::pi, 240);  // to the right
  expect_near(ray.d, {1, 0, 0}, 1e-7);
  EXPECT_FLOAT_EQ(ray.t_min, 2);
  EXPECT_FLOAT_EQ(ray.t_max, 5);
}

TEST(CalibratedCamera, PoseOfOpenCvExtrinsics) {
  // World x is the camera's z (forward), world y is its x (right), and world z is its -y (up).
  DMat4 camera_from_world(0);
  camera_from_world[0] = DVec4(0, 0, 1, 0);
  camera_from_world[1] = DVec4(1, 0, 0, 0);
  camera_from_world[2] = DVec4(0, -1, 0, 0);
  camera_from_world[3] = DVec4(7, 8, 9, 1);
  const Pose pose = pose_from_opencv(camera_from_world);
  EXPECT_EQ(pose.direction, DVec3(1, 0, 0));
  EXPECT_EQ(pose.up, DVec3(0, 0, 1));
  EXPECT_EQ(pose.position, DVec3(-9, -7, 8));
}

TEST(RayGenerator, ProjectsRaysToTheirPixels) {
  const Pose pose{.position = {1, 2, 3}, .direction = {3, -1, 2}, .up = {0.2, 1, 0}};
  const Camera cameras[] = {PerspectiveCamera{.pose = pose, .vertical_fov = 1.2},
                            OrthographicCamera{.pose = pose, .height = 7},
                            EnvironmentCamera{.pose = pose},
                            CalibratedCamera{.pose = pose, .fx = 700, .fy = 650, .cx = 17}};
  for (const Camera& camera : cameras) {
    const RayGenerator rays(camera, kCameraSize);
    for (double y = 0.5; y < 480; y += 13) {
      for (double x = 0.5; x < 640; x += 13) {
        const Ray ray = rays(x, y);
        const auto pixel = rays.project(DVec3(ray.o) + DVec3(ray.d) * 4.0);
        ASSERT_TRUE(pixel) << camera.index();
        EXPECT_LT(glm::length(*pixel - DVec2(x, y)), 1e-2) << camera.index();
      }
    }
  }
  EXPECT_FALSE(RayGenerator(cameras[0], kCameraSize).project(pose.position - pose.direction));
  EXPECT_FALSE(RayGenerator(cameras[2], kCameraSize).project(pose.position));
  const auto above = RayGenerator(EnvironmentCamera{}, kCameraSize).project({0, 3, 0});
  ASSERT_TRUE(above);
  EXPECT_EQ(above->y, 0);
  const auto behind = RayGenerator(EnvironmentCamera{}, kCameraSize).project({0, 0, 3});
  ASSERT_TRUE(behind);
  EXPECT_EQ(behind->x, 640);
  EXPECT_EQ(behind->y, 240);
}

TEST(RayGenerator, DifferentialsAreTheStepsToNeighboringPixels) {
  const Pose pose{.position = {1, 2, 3}, .direction = {3, -1, 2}, .up = {0.2, 1, 0}};
  const Camera cameras[] = {
      PerspectiveCamera{.pose = pose, .vertical_fov = 1.2},
      OrthographicCamera{.pose = pose, .height = 7},
      EnvironmentCamera{.pose = pose},
      CalibratedCamera{.pose = pose, .fx = 700, .fy = 650},
      CalibratedCamera{.pose = pose, .distortion = kStrong},
      CalibratedCamera{.pose = pose, .fx = 130, .fy = 140, .distortion = kWide}};
  for (const Camera& camera : cameras) {
    const RayGenerator ray(camera, kCameraSize);
    const Ray here = ray(100, 400);
    const RayDifferential step = ray.differential(here);
    // Estimates the differentials from rays ten pixels away on each side. The relative tolerance
    // covers float32 rounding.
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
