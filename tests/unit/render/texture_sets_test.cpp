// Checks that textures are filtered by the texture coordinates that they use. Before, path tracing
// took the size of footprints from set 0.

#include <microtrace/camera.hpp>
#include <microtrace/path.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>

#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kSize{.width = 32, .height = 32};

/// Returns an image of noise in colors and alpha.
Image noise() {
  std::mt19937 bits(3);
  Image image{.width = 64, .height = 64};
  std::vector<std::uint8_t> samples(std::size_t{64} * 64 * 4);
  for (std::uint8_t& sample : samples) sample = static_cast<std::uint8_t>(bits() >> 24U);
  image.samples = std::move(samples);
  return image;
}

/// Returns a square whose texture coordinates in set k are its coordinates times scales[k].
Mesh square(const std::vector<float>& scales) {
  Mesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
            .triangles = {{0, 1, 2}, {0, 2, 3}}};
  for (const float scale : scales) {
    std::vector<Vec2> uv;
    for (const Vec3& p : mesh.positions) uv.push_back(scale * Vec2(p));
    mesh.uv_sets.emplace_back(std::move(uv));
  }
  return mesh;
}

/// Returns the colors and the alpha of a path-traced picture of the square, whose texture uses this
/// set.
std::vector<Vec4> picture(Material material, const std::vector<float>& scales, std::uint32_t set) {
  TextureUse use{.texture = 0};
  use.uv_set = set;
  material.base_color_texture = use;
  Scene scene;
  scene.images.push_back(std::make_shared<const Image>(noise()));
  scene.textures.push_back({.image = 0});
  scene.materials.push_back(std::move(material));
  scene.objects.push_back({.name = "", .shape = square(scales), .material = 0});
  OrthographicCamera camera;
  camera.pose = {.position = {0, 0, 5}, .direction = {0, 0, -1}};
  camera.height = 2;
  const PathIntegrator light;
  Film film = render(PreparedScene(std::move(scene)), camera, kSize,
                     {.integrator = &light, .samples = 4, .transparent = true});
  std::vector<Vec4> pixels;
  for (std::uint32_t y = 0; y < kSize.height; ++y) {
    for (std::uint32_t x = 0; x < kSize.width; ++x)
      pixels.emplace_back(film.at(x, y), film.alpha_at(x, y));
  }
  return pixels;
}

TEST(TextureSets, AreFilteredByTheirOwnCoordinates) {
  for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
    for (const bool unlit : {true, false}) {
      for (const float scale : {0.25F, 1.0F, 8.0F}) {
        SCOPED_TRACE(scale);
        const Material material{.alpha_mode = mode, .unlit = unlit};
        const std::vector<Vec4> expected = picture(material, {scale}, 0);
        for (const float other : {0.0F, 0.01F, 50.0F})
          EXPECT_TRUE(picture(material, {other, scale}, 1) == expected) << other;
      }
    }
  }
}

}  // namespace
}  // namespace microtrace
