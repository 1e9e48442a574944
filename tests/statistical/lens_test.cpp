/// Compares the blur of points that are out of focus with the circle of confusion.
#include "support/pictures.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kSize{.width = 64, .height = 64};

PerspectiveCamera camera_with_lens() {
  return {.pose = {.position = {1, 2, 3}, .direction = {0.5, -0.25, -2}, .up = {0.1, 1, 0}},
          .vertical_fov = 0.6,
          .focus = 4,
          .lens_radius = 0.25,
          .depth = {.near = 0.5, .far = 90}};
}

TEST(Lens, RaysOfAPixelMeetInFocus) {
  const PerspectiveCamera camera = camera_with_lens();
  PerspectiveCamera pinhole = camera;
  pinhole.lens_radius = 0;
  const RayGenerator rays(camera, kSize), straight(pinhole, kSize);
  ASSERT_TRUE(rays.has_lens());
  ASSERT_FALSE(straight.has_lens());
  const DVec3 forward = glm::normalize(camera.pose.direction);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-0.7, 0.7), place(0, 64);
  for (int i = 0; i < 1000; ++i) {
    const double x = place(random), y = place(random);
    const Ray middle = rays.through_lens(x, y, {0, 0}), pin = straight(x, y);
    EXPECT_EQ(middle.o, pin.o);
    EXPECT_EQ(middle.d, pin.d);
    EXPECT_EQ(middle.t_min, pin.t_min);
    EXPECT_EQ(middle.t_max, pin.t_max);
    const DVec2 on_lens(u(random), u(random));
    const Ray ray = rays.through_lens(x, y, on_lens);
    const DVec3 to_lens = DVec3(ray.o) - camera.pose.position;
    EXPECT_NEAR(glm::dot(to_lens, forward), 0, 1e-6);
    EXPECT_NEAR(glm::length(to_lens), camera.lens_radius * glm::length(on_lens), 1e-6);
    const auto at_depth = [&](const Ray& r, double depth) {
      return DVec3(r.o) + DVec3(r.d) * (depth / glm::dot(DVec3(r.d), forward));
    };
    EXPECT_NEAR(glm::distance(at_depth(ray, camera.focus), at_depth(pin, camera.focus)), 0, 1e-5);
    // The range of depths is that of the pinhole.
    EXPECT_NEAR(glm::dot(DVec3(ray.d), forward) * double{ray.t_min}, camera.depth.near, 1e-6);
    EXPECT_NEAR(glm::dot(DVec3(ray.d), forward) * double{ray.t_max}, camera.depth.far, 1e-4);
  }
}

/// The light in a picture, and the root mean square distance of the light from the middle.
struct Spot {
  double light = 0, radius = 0;
};
Spot spot(double depth, double lens_radius, double focus) {
  Scene scene;
  scene.materials = {{.base_color = {0, 0, 0, 1}, .emissive = Vec3(1)}};
  const auto z = static_cast<float>(-depth);
  scene.objects.push_back(
      {.name = "point", .shape = Disc{{0, 0, z}, {0, 0, 1}, 0.004F * -z}, .material = 0});
  scene.environment = Environment{.content = Vec3(0)};
  const PerspectiveCamera camera{.vertical_fov = 0.5, .focus = focus, .lens_radius = lens_radius};
  const Film film = shoot(scene, camera, {.size = kSize, .samples = 512, .max_depth = 1});
  Spot result;
  for (std::uint32_t y = 0; y < kSize.height; ++y) {
    for (std::uint32_t x = 0; x < kSize.width; ++x) {
      const double light = double{film.row(y)[x].y};
      result.light += light;
      result.radius += light * (std::pow(x + 0.5 - 32, 2) + std::pow(y + 0.5 - 32, 2));
    }
  }
  result.radius = std::sqrt(result.radius / result.light);
  return result;
}

TEST(Lens, BlurHasTheRadiusOfTheCircleOfConfusion) {
  const double pixels = kSize.height / (2 * std::tan(0.25));
  const Spot sharp = spot(5, 0, 5);
  for (const auto& [depth, radius, focus] :
       {std::array{5.0, 0.2, 5.0}, std::array{2.5, 0.15, 5.0}, std::array{10.0, 0.4, 4.0}}) {
    const Spot blurred = spot(depth, radius, focus);
    const double confusion = radius * std::abs(depth - focus) / (depth * focus) * pixels;
    // The mean square distance within a uniform disk is half the square of its radius.
    const double expected = std::sqrt(sharp.radius * sharp.radius + confusion * confusion / 2);
    EXPECT_NEAR(blurred.radius, expected, 0.03 * expected) << depth;
    EXPECT_NEAR(blurred.light, sharp.light, 0.03 * sharp.light) << depth;
  }
}

/// A floor and a ball that emits light, all lengths multiplied by a factor.
Film scaled_picture(float factor) {
  Scene scene;
  scene.materials = {{}, {.emissive = Vec3(2, 1, 0.5F)}};
  const Mesh floor =
      parallelogram(factor * Vec3(-4, -1, 0), factor * Vec3(8, 0, 0), factor * Vec3(0, 0, -8));
  scene.objects.push_back({.name = "floor", .shape = floor, .material = 0});
  scene.objects.push_back(
      {.name = "ball", .shape = Sphere{factor * Vec3(0.5F, 0, -3), factor * 0.75F}, .material = 1});
  scene.environment = Environment{.content = Vec3(0.2F)};
  const PerspectiveCamera camera{.pose = {.position = double{factor} * DVec3(0.1, 0.3, 2)},
                                 .vertical_fov = 0.7,
                                 .focus = 5.0 * double{factor},
                                 .lens_radius = 0.3 * double{factor}};
  return shoot(scene, camera, {.size = {.width = 24, .height = 18}, .samples = 8});
}

TEST(Lens, ScalesWithTheScene) {
  const auto pixels = pixels_of(scaled_picture(1));
  for (const float factor : {0x1p-20F, 0x1p7F, 0x1p30F})
    EXPECT_EQ(pixels_of(scaled_picture(factor)), pixels) << factor;
}

}  // namespace
}  // namespace microtrace
