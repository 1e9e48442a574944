#include "support/pi.hpp"
#include "support/shading/scattering.hpp"

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Renders a picture and returns the mean of all pixels.
DVec3 mean(const Scene& scene, const Camera& camera, std::uint32_t samples,
           const PathOptions& options = {}, ImageSize size = {16, 16}) {
  const PathIntegrator path(options);
  const Film film = render(scene, camera, size, {.integrator = &path, .samples = samples});
  DVec3 sum(0);
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (const Vec3& pixel : film.row(y)) sum += DVec3(pixel);
  }
  return sum / double(size.width) / double(size.height);
}

Mesh quad(const Vec3& corner, const Vec3& along, const Vec3& up) {
  return {.positions = {corner, corner + along, corner + along + up, corner + up},
          .triangles = {{{0, 1, 2}}, {{0, 2, 3}}}};
}

/// A floor at y = 0 that faces up. The camera sees a small window around (0, 0, 0) from straight
/// above.
struct Floor {
  explicit Floor(const Material& material) {
    scene.materials = {material};
    scene.objects.push_back(
        {.name = "floor", .shape = quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}), .material = 0});
    scene.environment = Environment{.content = Vec3(0)};
  }
  Scene scene;
  OrthographicCamera camera{
      .pose = {.position = {0, 1, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 0.01};
};

/// Returns the BSDF of a rough dielectric that is seen from straight above and lit at an angle.
double rough_reflectance(float albedo, double cosine) {
  const bsdf::Scattering bsdf({.base_color = Vec3(albedo)}, {0, 0, 1});
  return bsdf.evaluate({std::sqrt(1 - cosine * cosine), 0, cosine}).value.x / cosine;
}

TEST(Path, PointLightOverFloor) {
  Floor floor({.base_color = {0.5F, 0.5F, 0.5F, 1}});
  floor.scene.lights.push_back(
      {.name = "lamp", .light = PointLight{.position = {3, 4, 0}, .intensity = 100}});
  const double expected = rough_reflectance(0.5F, 0.8) * 0.8 * 100 / 25;
  EXPECT_NEAR(mean(floor.scene, floor.camera, 4).x, expected, 0.001 * expected);
}

TEST(Path, DirectionalAndSpotLightOverFloor) {
  Floor sun({.base_color = {0.8F, 0.8F, 0.8F, 1}});
  sun.scene.lights.push_back(
      {.name = "sun", .light = DirectionalLight{.direction = {0, -1, 0}, .intensity = 3}});
  const double overhead = rough_reflectance(0.8F, 1) * 3;
  EXPECT_NEAR(mean(sun.scene, sun.camera, 4).x, overhead, 0.001 * overhead);

  Floor spot({.base_color = {0.8F, 0.8F, 0.8F, 1}});
  const auto shine = [&](double angle) {
    spot.scene.lights = {{.name = "spot",
                          .light = SpotLight{.position = {0, 2, 0},
                                             .direction = {std::sin(angle), -std::cos(angle), 0},
                                             .intensity = 8,
                                             .inner_angle = 0.2,
                                             .outer_angle = 0.6}}};
    return mean(spot.scene, spot.camera, 4).x;
  };
  const double full = rough_reflectance(0.8F, 1) * 8 / 4;
  EXPECT_NEAR(shine(0.1), full, 0.001 * full);
  const double share = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
  EXPECT_NEAR(shine(0.4), full * share * share, 0.001 * full);
  EXPECT_EQ(shine(0.7), 0);
}

// Compares a square area light over the floor with the midpoint rule over the light.
TEST(Path, AreaLightOverFloor) {
  Floor floor({.base_color = {0.5F, 0.5F, 0.5F, 1}});
  floor.scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = {2, 3, 4}});
  floor.scene.objects.push_back(
      {.name = "lamp", .shape = quad({1, 2, -1}, {0, 0, 2}, {2, 0, 0}), .material = 1});
  double expected = 0;
  constexpr int steps = 200;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double x = 1 + 2 * (i + 0.5) / steps, z = -1 + 2 * (j + 0.5) / steps;
      const double square = x * x + 4 + z * z, cosine = 2 / std::sqrt(square);
      expected += rough_reflectance(0.5F, cosine) * cosine * cosine / square * 4 / (steps * steps);
    }
  }
  const DVec3 got = mean(floor.scene, floor.camera, 64, {.max_depth = 2});
  EXPECT_NEAR(got.x, 2 * expected, 0.02 * expected * 2);
  EXPECT_NEAR(got.z / got.x, 2, 1e-5);
}

// In a uniform environment, a non-absorbing object must be invisible.
TEST(Path, WhiteMetalVanishesInTheFurnace) {
  Scene scene;
  scene.materials = {{.metallic = 1, .roughness = 0.6F}, {.metallic = 1, .roughness = 0.1F}};
  scene.objects.push_back({.name = "rough", .shape = Sphere{{-1, 0, -5}, 1}, .material = 0});
  scene.objects.push_back({.name = "smooth", .shape = Sphere{{1, 0, -5}, 1}, .material = 1});
  scene.environment = Environment{.content = Vec3(1), .is_background = true};
  const double light =
      mean(scene, PerspectiveCamera{}, 64, {.max_depth = 64}, {.width = 32, .height = 24}).x;
  EXPECT_NEAR(light, 1, 0.002);
}

TEST(Path, PathsBetweenWhiteSurfacesEnd) {
  Scene scene;
  scene.materials = {{.metallic = 0, .specular = Specular{.factor = 0}}};
  scene.objects.push_back({.name = "room", .shape = Sphere{{0, 0, 0}, 1}, .material = 0});
  scene.lights.push_back({.name = "lamp", .light = PointLight{.position = {0, 0.5F, 0}}});
  const PathIntegrator path({.max_depth = 65536});
  (void)render(scene, PerspectiveCamera{}, {.width = 16, .height = 16},
               {.integrator = &path, .samples = 4});
  const RayCounts rays = path.ray_counts();
  EXPECT_GT(rays.path.rays, 20 * rays.camera.rays);
  EXPECT_LT(rays.path.rays, 200 * rays.camera.rays);
}

TEST(Path, DepthOneIsEmissionOnly) {
  Floor floor({.emissive = {0.25F, 0.5F, 1}});
  floor.scene.environment = Environment{.content = Vec3(1)};
  EXPECT_EQ(mean(floor.scene, floor.camera, 2, {.max_depth = 1}), DVec3(0.25, 0.5, 1));
  EXPECT_GT(mean(floor.scene, floor.camera, 2, {.max_depth = 2}).x, 1);
}

// A half-opaque pane must be blended over the emitter behind it.
TEST(Path, BlendedSurfacesTransmitByOpacity) {
  Floor floor({.emissive = {1, 1, 1}});
  floor.scene.materials.push_back({.base_color = {0, 0, 0, 0.5F}, .alpha_mode = AlphaMode::blend});
  floor.scene.objects.push_back(
      {.name = "pane", .shape = quad({-9, 0.5F, 9}, {18, 0, 0}, {0, 0, -18}), .material = 1});
  EXPECT_NEAR(mean(floor.scene, floor.camera, 256, {.max_depth = 1}).x, 0.5, 0.01);
}

TEST(Path, BytesDependOnlyOnTheScene) {
  Scene scene;
  scene.materials = {{.base_color = {0.9F, 0.3F, 0.2F, 1}, .metallic = 0.5F, .roughness = 0.3F}};
  for (int i = 0; i < 30; ++i) {
    scene.objects.push_back({.name = "ball",
                             .shape = Sphere{{float(i % 6) - 2.5F, float(i / 6) - 2, -6}, 0.6F},
                             .material = 0});
  }
  const PathIntegrator path;
  const auto draw = [&](const RenderOptions& options) {
    return render(scene, PerspectiveCamera{}, {.width = 40, .height = 30}, options);
  };
  const RenderOptions options{.threads = 1, .integrator = &path, .samples = 20};
  const Film one = draw(options);
  RenderOptions several = options;
  several.threads = 5;
  RenderOptions cropped = options;
  cropped.crop = PixelRect{.x0 = 11, .y0 = 5, .x1 = 29, .y1 = 28};
  RenderOptions other = options;
  other.seed = 1;
  const Film five = draw(several);
  Film crop = draw(cropped), reseeded = draw(other);
  bool differs = false;
  for (std::uint32_t y = 0; y < 30; ++y) {
    for (std::uint32_t x = 0; x < 40; ++x) {
      const Vec3 pixel = one.row(y)[x];
      ASSERT_EQ(pixel, five.row(y)[x]);
      differs |= pixel != reseeded.at(x, y);
      if (x >= 11 && x < 29 && y >= 5 && y < 28) {
        ASSERT_EQ(pixel, crop.at(x - 11, y - 5));
      }
    }
  }
  EXPECT_TRUE(differs);
}

/// Appends a parallelogram.
Mesh& add_mesh(Scene& scene, const Vec3& corner, const Vec3& along, const Vec3& up,
               std::uint32_t material) {
  scene.objects.push_back({.name = "mesh", .shape = quad(corner, along, up), .material = material});
  return std::get<Mesh>(scene.objects.back().shape);
}

/// A room with surfaces of many kinds, each of a mesh without attributes, except for two.
Scene room_of_meshes() {
  Scene scene;
  scene.materials = {
      {.base_color = {0.8F, 0.7F, 0.6F, 1}},
      {.base_color = {0.9F, 0.5F, 0.3F, 1}, .double_sided = false, .roughness = 0.4F},
      {.emissive = {4, 3, 2}},
      {.base_color = {1, 1, 1, 0.5F}, .alpha_mode = AlphaMode::blend}};
  Material brushed{.metallic = 1, .roughness = 0.4F, .emissive = Vec3(0.01F)};
  brushed.anisotropy = Anisotropy{.strength = 1};
  scene.materials.push_back(brushed);
  Material glass{.roughness = 0.1F};
  glass.transmission = Transmission{.factor = 1};
  scene.materials.push_back(glass);
  add_mesh(scene, {-3, -1, -6}, {6, 0, 0}, {0, 4, 0}, 0).normals =
      std::vector<Vec3>(4, Vec3(0, 0, 1));
  add_mesh(scene, {-1, -0.9F, -2}, {2, 0, 0}, {0, 0, -2}, 4).tangents =
      std::vector<Vec4>{{1, 0, 0, 1}, {0, 0, 1, 1}, {-1, 0, 0, 1}, {0, 0, -1, 1}};
  add_mesh(scene, {-3, -1, 0}, {6, 0, 0}, {0, 0, -6}, 0);
  add_mesh(scene, {-3, -1, 0}, {0, 0, -6}, {0, 4, 0}, 1);
  add_mesh(scene, {-1, 2.5F, -4}, {0, 0, 1}, {1, 0, 0.25F}, 2);
  add_mesh(scene, {0.5F, -0.5F, -3}, {1, 0, 0.5F}, {0, 1, 0}, 3);
  add_mesh(scene, {-1.5F, -0.5F, -3}, {1, 0, 0.5F}, {0, 1, 0}, 5);
  return scene;
}

// An empty set of texture coordinates changes nothing but the code that finds the points.
TEST(Path, FlatTrianglesHaveTheBytesOfOthers) {
  const Scene flat = room_of_meshes();
  Scene other = flat;
  for (Object& object : other.objects) std::get<Mesh>(object.shape).uv_sets = {{}};
  const PathIntegrator path;
  const auto draw = [&](const Scene& scene, unsigned threads) {
    return render(scene, PerspectiveCamera{}, {.width = 64, .height = 48},
                  {.threads = threads, .integrator = &path, .samples = 16});
  };
  const Film expected = draw(other, 1), one = draw(flat, 1), several = draw(flat, 3);
  for (std::uint32_t y = 0; y < 48; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      ASSERT_EQ(one.row(y)[x], expected.row(y)[x]) << x << ", " << y;
      ASSERT_EQ(several.row(y)[x], expected.row(y)[x]) << x << ", " << y;
    }
  }
}

/// Adds a gray texture and returns its index.
std::uint32_t add_texture(Scene& scene, std::uint32_t width, std::uint32_t height,
                          std::vector<std::uint8_t> grays, Wrap wrap) {
  scene.images.push_back(std::make_shared<const Image>(
      Image{.width = width, .height = height, .channels = 1, .samples = std::move(grays)}));
  scene.textures.push_back({.image = static_cast<std::uint32_t>(scene.images.size() - 1),
                            .sampler = {.wrap_s = wrap, .wrap_t = wrap}});
  return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

// White and black textures change nothing but the code that looks textures up, wherever and however
// large they are.
TEST(Path, TexturesOfDifferentSizesAreLookedUpEachInItsOwnWay) {
  Scene scene = room_of_meshes();
  for (Object& object : scene.objects)
    std::get<Mesh>(object.shape).uv_sets = {{{0, 0}, {1.5F, 0}, {1.5F, 1.5F}, {0, 1.5F}}};
  std::vector<std::uint8_t> noise;
  for (std::uint32_t i = 0; i < 64 * 64; ++i) noise.push_back(static_cast<std::uint8_t>(i * i / 7));
  const std::uint32_t rough = add_texture(scene, 64, 64, noise, Wrap::repeat);
  const std::uint32_t black =
      add_texture(scene, 64, 64, std::vector<std::uint8_t>(64 * 64, 0), Wrap::repeat);
  for (Material& material : scene.materials) {
    material.metallic_roughness_texture = TextureUse{.texture = rough};
    if (material.emissive != Vec3(0)) continue;
    material.emissive = Vec3(5);
    material.emissive_texture = TextureUse{.texture = black};
  }
  Scene other = scene;
  const std::uint32_t white =
      add_texture(other, 3, 7, std::vector<std::uint8_t>(21, 255), Wrap::clamp_to_edge);
  const std::uint32_t dark =
      add_texture(other, 16, 1, std::vector<std::uint8_t>(16, 0), Wrap::mirrored_repeat);
  for (Material& material : other.materials) {
    const Mat3x2 turned(0, -3, 2, 0, 0.25F, 0.5F);
    material.base_color_texture = TextureUse{.texture = white, .texture_from_uv = turned};
    if (material.emissive_texture) material.emissive_texture->texture = dark;
  }
  const PathIntegrator path;
  const auto draw = [&](const Scene& drawn) {
    return render(drawn, PerspectiveCamera{}, {.width = 64, .height = 48},
                  {.integrator = &path, .samples = 16});
  };
  const Film expected = draw(scene), film = draw(other);
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x)
      ASSERT_EQ(film.row(y)[x], expected.row(y)[x]) << x << ", " << y;
}

}  // namespace
}  // namespace microtrace
