// White furnace test of the whole renderer: in a uniform environment, spheres that absorb nothing
// must be invisible, at any angle and with any layers.

#include "support/pictures.hpp"

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns the mean radiance of a sphere of radius 1 in light of radiance 1. The mean extends up to
/// this distance from the sphere's center.
double brightness(const Material& material, double radius) {
  Scene scene;
  scene.materials = {material};
  scene.objects.push_back({.name = "sphere",
                           .shape = Sphere{.center = {0.3F, -0.1F, 0.2F}, .radius = 1},
                           .material = 0});
  scene.environment = Environment{.content = Vec3(1)};
  const OrthographicCamera camera{
      .pose = {.position = {0.3, -0.1, 4}, .direction = {0, 0, -1}, .up = {0, 1, 0}},
      .height = 2 * radius / std::sqrt(2.0)};
  const PathIntegrator path;
  const Film film = render(scene, camera, {16, 16}, {.integrator = &path, .samples = 512});
  double sum = 0;
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (const Vec3& pixel : film.row(y)) sum += double{pixel.x} + pixel.y + pixel.z;
  }
  return sum / (3 * 16 * 16);
}

TEST(WhiteSphere, CannotBeSeen) {
  for (const float roughness : {0.2F, 0.6F, 1.0F}) {
    const auto expect_white = [&](const std::string& what, const Material& material) {
      EXPECT_NEAR(brightness(material, 0.95), 1, 0.005) << what << ' ' << roughness;
    };
    const Material plastic{.metallic = 0, .roughness = roughness};
    Material metal = plastic;
    metal.metallic = 1;
    expect_white("plastic", plastic);
    expect_white("metal", metal);
    for (const float coat_roughness : {0.05F, 0.5F}) {
      Material coated_plastic = plastic, coated_metal = metal;
      coated_plastic.clearcoat = Clearcoat{.factor = 1, .roughness = coat_roughness};
      coated_metal.clearcoat = coated_plastic.clearcoat;
      expect_white("coat on plastic", coated_plastic);
      expect_white("coat on metal", coated_metal);
    }
    Material wall = plastic, cloth = plastic;
    wall.transmission = Transmission{.factor = 0.7F};
    wall.double_sided = true;
    cloth.sheen = Sheen{.color = Vec3(1), .roughness = 0.5F};
    expect_white("thin walls", wall);
    expect_white("cloth", cloth);
  }
}

/// Returns the mean radiance of a coated square in light of radiance 1, seen at an angle to its
/// normal. The normals of the base are turned by atan(slope) toward the camera.
double brightness_of_coat(const Material& coated, double theta, double slope) {
  Scene scene;
  const double length = std::sqrt(1 + slope * slope);
  std::vector<std::uint8_t> texel;
  for (const double x : {slope / length, 0.0, 1 / length, 1.0})
    texel.push_back(static_cast<std::uint8_t>(std::lround(127.5 * (x + 1))));
  scene.images.push_back(
      std::make_shared<const Image>(Image{.width = 1, .height = 1, .samples = std::move(texel)}));
  scene.textures.push_back({.image = 0});
  scene.materials = {coated};
  scene.materials[0].normal_texture = TextureUse{.texture = 0};
  Mesh square = parallelogram({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  square.normals = std::vector(4, Vec3(0, 1, 0));
  square.tangents = std::vector(4, Vec4(1, 0, 0, 1));
  square.uv_sets = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  scene.objects.push_back({.name = "square", .shape = std::move(square), .material = 0});
  scene.environment = Environment{.content = Vec3(1)};
  const DVec3 toward(std::sin(theta), std::cos(theta), 0);
  const OrthographicCamera camera{
      .pose = {.position = 4.0 * toward, .direction = -toward, .up = {0, 1, 0}}, .height = 0.1};
  const PathIntegrator path;
  return mean_of(render(scene, camera, {8, 8}, {.integrator = &path, .samples = 4096})).x;
}

// Toward the camera, the coat reflects to directions below the horizon of the base's normal.
TEST(WhiteSquare, CannotBeSeenUnderACoatOfItsOwn) {
  for (const float roughness : {0.05F, 0.4F, 0.9F}) {
    const Material plastic{
        .metallic = 0, .roughness = roughness, .clearcoat = Clearcoat{.factor = 1, .roughness = 0}};
    for (const double theta : {0.2, 0.8, 1.2, 1.4}) {
      for (const double slope : {0.1, 0.3})
        EXPECT_NEAR(brightness_of_coat(plastic, theta, slope), 0.997, 0.006)
            << roughness << ' ' << theta << ' ' << slope;
    }
  }
}

}  // namespace
}  // namespace microtrace
