// White furnace test of the whole renderer: in a uniform environment, spheres that absorb nothing
// must be invisible, at any angle and with any layers.

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <optional>
#include <string>

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

}  // namespace
}  // namespace microtrace
