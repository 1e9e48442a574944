/// Compares the light that arrives from mipmapped textures with closed-form results. Paths that a
/// diffuse surface scatters have wide footprints, but must find the light that light sampling and
/// shadow rays find.
#include "support/pi.hpp"
#include "support/pictures.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr std::uint32_t kPixels = 512;  ///< side of the textures

/// Adds a mipmapped texture. is_white(x, y) selects the pixels that are white and opaque; the
/// others are black and transparent.
template <class IsWhite>
TextureUse add_texture(Scene& scene, const IsWhite& is_white) {
  std::vector<std::uint8_t> samples;
  for (std::uint32_t y = 0; y < kPixels; ++y) {
    for (std::uint32_t x = 0; x < kPixels; ++x)
      samples.insert(samples.end(), 4, is_white(x, y) ? 255 : 0);
  }
  scene.images.push_back(std::make_shared<const Image>(
      Image{.width = kPixels, .height = kPixels, .samples = std::move(samples)}));
  scene.textures.push_back({.image = 0});
  return {.texture = 0};
}

/// A floor at y = 0 that reflects half of the light diffusely, seen from straight above, and a
/// black square at y = 1. The square shows the part of its texture from `margin` to 1 - `margin`.
struct FloorBelowSquare {
  FloorBelowSquare(float half_side, float margin) {
    scene.materials = {{.base_color = {0.5F, 0.5F, 0.5F, 1}, .specular = Specular{.factor = 0}},
                       {.base_color = {0, 0, 0, 1}, .specular = Specular{.factor = 0}}};
    scene.objects.push_back(
        {.name = "floor", .shape = Plane{.point = {}, .normal = {0, 1, 0}}, .material = 0});
    const float a = half_side, low = margin, high = 1 - margin;
    Mesh mesh = parallelogram({-a, 1, -a}, {2 * a, 0, 0}, {0, 0, 2 * a});
    mesh.uv_sets = {{{low, low}, {high, low}, {high, high}, {low, high}}};
    scene.objects.push_back({.name = "square", .shape = std::move(mesh), .material = 1});
    scene.environment = Environment{.content = Vec3(0)};
  }
  [[nodiscard]] Material& square() { return scene.materials[1]; }
  void expect_seen(double expected) const {
    const OrthographicCamera camera{
        .pose = {.position = {0, 0.5, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}},
        .height = 0.001};
    const Shot shot{.size = {.width = 8, .height = 8}, .samples = 256, .max_depth = 2};
    const Estimate seen = estimate(scene, camera, shot, 12);
    EXPECT_NEAR(seen.mean, expected, 5.8 * seen.deviation) << seen.deviation;
  }
  Scene scene;
};

// A square lamp shows the white part of a texture that is black elsewhere. Its light is that of a
// uniform lamp. Lamps that are unlit are found by BSDF sampling only.
TEST(TexturedLight, LampInAnAtlasIsUniform) {
  constexpr std::uint32_t kFirst = 231, kEnd = kPixels - kFirst;
  const auto is_window = [](std::uint32_t x, std::uint32_t y) {
    return x >= kFirst && x < kEnd && y >= kFirst && y < kEnd;
  };
  const double side = 0.5 / std::sqrt(1.25);
  const double form_factor = 4 / kPi * side * std::atan(side);
  for (const bool unlit : {false, true}) {
    FloorBelowSquare lit(0.5F, (kFirst + 1) / float{kPixels});
    lit.square().emissive = Vec3(1);
    lit.square().emissive_texture = add_texture(lit.scene, is_window);
    if (unlit) lit.square() = {.base_color_texture = lit.square().emissive_texture, .unlit = true};
    lit.expect_seen(0.5 * form_factor);
  }
}

// A canopy with slits that are finer than footprints, under uniform light. The light of a map is
// sampled, that of a constant is not.
TEST(TexturedLight, MaskBlocksItsOpaquePart) {
  for (const bool is_map : {false, true}) {
    FloorBelowSquare lit(1000, -100);
    lit.square().base_color_texture =
        add_texture(lit.scene, [](std::uint32_t x, std::uint32_t) { return x % 8 < 3; });
    lit.square().alpha_mode = AlphaMode::mask;
    lit.scene.environment->content = Vec3(1);
    if (is_map) {
      RadianceMap map{.width = 16, .height = 8};
      map.pixels.assign(16 * 8, Vec3(1));
      map.pixels[0] = Vec3(1.001F);  // so that the map is not uniform
      lit.scene.environment->content = std::make_shared<const RadianceMap>(std::move(map));
    }
    lit.expect_seen(0.5 * 5 / 8);
  }
}

}  // namespace
}  // namespace microtrace
