// Tests paths through surfaces with transparent and blended parts.

#include "support/pictures.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// How the transparent halves are made.
enum class Holes : std::uint8_t { absent, masked, blended };

/// Two texels, of which the second is transparent.
void add_half_transparent_texture(Scene& scene) {
  scene.images.push_back(std::make_shared<const Image>(
      Image{.width = 2,
            .height = 1,
            .channels = 4,
            .samples = std::vector<std::uint8_t>{255, 255, 255, 255, 255, 255, 255, 0}}));
  scene.textures.push_back({.image = 0,
                            .sampler = {.wrap_s = Wrap::clamp_to_edge,
                                        .magnification = Filter::nearest,
                                        .minification = Filter::nearest,
                                        .mip = MipFilter::none}});
}

/// A floor under many leaves, whose second halves are missing or transparent, in the light of the
/// sky, a sun and a lamp.
Scene leaves(Holes holes, bool double_sided) {
  Scene scene;
  add_half_transparent_texture(scene);
  Material leaf{.base_color = {0.3F, 0.7F, 0.2F, 1}, .double_sided = double_sided, .roughness = 1};
  if (holes != Holes::absent) {
    leaf.base_color_texture = TextureUse{};
    leaf.alpha_mode = holes == Holes::masked ? AlphaMode::mask : AlphaMode::blend;
  }
  scene.materials = {{.base_color = {0.5F, 0.5F, 0.5F, 1}, .roughness = 1},
                     leaf,
                     {.base_color = {0, 0, 0, 1}, .emissive = Vec3(20)}};
  scene.objects.push_back(
      {.shape = parallelogram({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), .material = 0});
  scene.objects.push_back(
      {.shape = parallelogram({-0.5F, 3.5F, -0.5F}, {1, 0, 0}, {0, 0, 1}), .material = 2});
  std::mt19937 bits(5);
  const auto number = [&](float lo, float hi) {
    return lo + (hi - lo) * static_cast<float>(bits() >> 8U) * 0x1p-24F;
  };
  for (int i = 0; i < 60; ++i) {
    const Vec3 corner(number(-2, 2), number(0.3F, 3), number(-2, 2));
    const Vec3 along(number(-1, 1), number(-0.2F, 0.2F), number(-1, 1));
    const Vec3 up(number(-1, 1), number(-0.2F, 0.2F), number(-1, 1));
    Mesh mesh = parallelogram(corner, holes == Holes::absent ? along * 0.5F : along, up);
    if (holes != Holes::absent) mesh.uv_sets.push_back({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    scene.objects.push_back({.shape = mesh, .material = 1});
  }
  scene.environment = Environment{.content = Vec3(0.5F)};
  scene.lights.push_back({.name = "sun",
                          .light = DirectionalLight{
                              .direction = glm::normalize(DVec3(0.2, -1, 0.3)), .intensity = 2}});
  return scene;
}

/// A floor, a ceiling, and in between an emissive sheet of small triangles, every second of which
/// is missing or transparent. `place` is the distance from the scene's center on two axes.
Scene sheet_at(float place, Holes holes) {
  constexpr int kEdge = 8;
  constexpr float kHalf = 0x1p-6F;
  Scene scene;
  add_half_transparent_texture(scene);
  Material lamp{.base_color = {0, 0, 0, 1}, .double_sided = true, .emissive = Vec3(5)};
  if (holes != Holes::absent) {
    lamp.base_color_texture = TextureUse{};
    lamp.alpha_mode = AlphaMode::mask;
  }
  scene.materials = {{.base_color = {0.8F, 0.8F, 0.8F, 1}, .roughness = 1}, lamp};
  scene.objects.push_back({.shape = parallelogram({place - 2 * kHalf, place, 2 * kHalf},
                                                  {4 * kHalf, 0, 0}, {0, 0, -4 * kHalf}),
                           .material = 0});
  scene.objects.push_back({.shape = parallelogram({place - 2 * kHalf, place + 3 * kHalf, 2 * kHalf},
                                                  {4 * kHalf, 0, 0}, {0, 0, -4 * kHalf}),
                           .material = 0});
  // Keeps the center of the scene at the origin.
  scene.objects.push_back(
      {.shape = parallelogram({-place, -place, 0}, {1, 0, 0}, {0, 0, -1}), .material = 0});
  Mesh sheet;
  sheet.uv_sets.emplace_back();
  const auto corner = [place](int i, int k) {
    const auto at = [](int n) { return kHalf * (2 * static_cast<float>(n) / kEdge - 1); };
    return Vec3(place + at(i), place + kHalf, at(k));
  };
  const auto add = [&](const Vec3(&corners)[3], bool is_hole) {
    if (is_hole && holes == Holes::absent) return;
    const auto first = static_cast<std::uint32_t>(sheet.positions.size());
    for (const Vec3& p : corners) {
      sheet.positions.push_back(p);
      sheet.uv_sets[0].push_back({is_hole ? 0.75F : 0.25F, 0.5F});
    }
    sheet.triangles.push_back({first, first + 1, first + 2});
  };
  for (int i = 0; i < kEdge; ++i) {
    for (int k = 0; k < kEdge; ++k) {
      add({corner(i, k), corner(i, k + 1), corner(i + 1, k)}, k % 2 != 0);
      add({corner(i + 1, k), corner(i, k + 1), corner(i + 1, k + 1)}, k % 2 == 0);
    }
  }
  scene.objects.push_back({.shape = sheet, .material = 1});
  return scene;
}

/// The fraction of pixels that differ by more than rounding.
double differing(const Film& a, const Film& b) {
  const std::vector<DVec3> x = pixels_of(a), y = pixels_of(b);
  double count = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    count += std::abs(x[i].y - y[i].y) > 1e-3 * (x[i].y + y[i].y) ? 1 : 0;
  return count / static_cast<double>(x.size());
}

TEST(MaskedPaths, PassHolesAsIfTheyWereAbsent) {
  const PerspectiveCamera camera{.pose = {.position = {0, 5, 4},
                                          .direction = glm::normalize(DVec3(0, -1, -0.8)),
                                          .up = {0, 1, 0}}};
  for (const bool double_sided : {false, true}) {
    for (const Backfaces backfaces : {Backfaces::pass, Backfaces::occlude}) {
      const Shot shot{.size = {.width = 48, .height = 48}, .samples = 4, .backfaces = backfaces};
      const Film expected = shoot(leaves(Holes::absent, double_sided), camera, shot);
      EXPECT_GT(differing(expected, shoot(leaves(Holes::absent, !double_sided), camera, shot)),
                0.2);
      for (const Holes holes : {Holes::masked, Holes::blended}) {
        const Film film = shoot(leaves(holes, double_sided), camera, shot);
        EXPECT_LT(differing(expected, film), 0.02)
            << (double_sided ? "two" : "one") << " sides, "
            << (holes == Holes::masked ? "masked" : "blended") << ", backfaces "
            << static_cast<int>(backfaces);
      }
    }
  }
}

// Far from the center, the sampled point of a light is rounded so much that rays often pass beside
// its triangle: they hit a transparent neighbor, or what is behind the light.
TEST(MaskedPaths, LoseNoLightBesideSmallTriangles) {
  const auto mean = [](float place, Holes holes) {
    const PerspectiveCamera camera{.pose = {.position = {place, place + 0x1p-7F, 0x1p-3F},
                                            .direction = glm::normalize(DVec3(0, -0.01, -0.1)),
                                            .up = {0, 1, 0}},
                                   .vertical_fov = 0.1};
    const Shot shot{.size = {.width = 16, .height = 8}, .samples = 16384, .max_depth = 2};
    return mean_of(shoot(sheet_at(place, holes), camera, shot)).y;
  };
  const double expected = mean(2, Holes::absent);
  for (const Holes holes : {Holes::absent, Holes::masked}) {
    for (const float place : {2.0F, 768.0F}) EXPECT_NEAR(mean(place, holes) / expected, 1, 3e-3);
  }
}

/// A floor under tilted sheets that let light pass where x is negative, with these opacities in
/// units of 1 / 5, and are transparent elsewhere.
Scene sheets_over_floor(const std::vector<int>& opacities) {
  Scene scene;
  scene.materials = {{.base_color = {0.5F, 0.5F, 0.5F, 1}, .roughness = 1}};
  scene.objects.push_back(
      {.shape = parallelogram({-10, 0, 10}, {20, 0, 0}, {0, 0, -20}), .material = 0});
  // Many triangles, so that the tree splits the large ones.
  for (int i = 0; i < 400; ++i) {
    const Vec3 at(6 + 0.1F * static_cast<float>(i % 20), 1 + 0.1F * static_cast<float>(i / 20), 3);
    scene.objects.push_back({.shape = parallelogram(at, {0.05F, 0, 0}, {0, 0.05F, 0})});
  }
  for (std::uint32_t i = 0; i < opacities.size(); ++i) {
    const auto alpha = static_cast<std::uint8_t>(51 * opacities[i]);
    add_half_transparent_texture(scene);
    scene.images.back() = std::make_shared<const Image>(
        Image{.width = 2,
              .height = 1,
              .channels = 4,
              .samples = std::vector<std::uint8_t>{255, 255, 255, alpha, 255, 255, 255, 0}});
    scene.textures.back().image = i;
    scene.materials.push_back({.base_color = {0, 0, 0, 1},
                               .base_color_texture = TextureUse{.texture = i},
                               .alpha_mode = AlphaMode::blend,
                               .double_sided = true});
    const float tilt = 0.1F * static_cast<float>(i + 1);
    Mesh sheet = parallelogram({-8, 2 + tilt, 8}, {16, tilt, 0}, {0, -tilt, -16});
    sheet.uv_sets.push_back({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    scene.objects.push_back({.shape = sheet, .material = i + 1});
  }
  return scene;
}

TEST(MaskedPaths, MultiplyTheLightThatPassesBlendedSheets) {
  const PerspectiveCamera camera{
      .pose = {.position = {-4, 1, 0}, .direction = {0, -1, 0}, .up = {0, 0, 1}},
      .vertical_fov = 0.2};
  const auto add_sun = [](Scene& scene) {
    scene.lights.push_back(
        {.name = "", .light = DirectionalLight{.direction = {0, -1, 0}, .intensity = 2}});
  };
  const auto add_bulb = [](Scene& scene) {
    scene.lights.push_back(
        {.name = "", .light = PointLight{.position = {-4, 5, 0}, .intensity = 100}});
  };
  const auto add_lamp = [](Scene& scene) {
    scene.environment = Environment{.content = Vec3(0)};
    const auto material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = Vec3(50)});
    scene.objects.push_back(
        {.shape = parallelogram({-4.5F, 5, -0.5F}, {1, 0, 0}, {0, 0, 1}), .material = material});
  };
  // A blended sheet closely behind a lamp, whose light doesn't pass it.
  const auto add_lamp_and_sheet = [&](Scene& scene) {
    add_lamp(scene);
    scene.objects.push_back({.shape = parallelogram({-4.5F, 5.01F, -0.5F}, {1, 0, 0}, {0, 0, 1}),
                             .material = static_cast<std::uint32_t>(scene.materials.size())});
    scene.materials.push_back({.base_color = {0, 0, 0, 0.6F}, .alpha_mode = AlphaMode::blend});
  };
  const auto light = [&](const auto& add, const std::vector<int>& opacities) {
    Scene scene = sheets_over_floor(opacities);
    add(scene);
    const Shot shot{.size = {.width = 32, .height = 32}, .samples = 16, .max_depth = 2};
    return mean_of(shoot(scene, camera, shot)).y;
  };
  const auto check = [&](const char* name, const auto& add, const auto& add_bare) {
    const double bare = light(add_bare, {});
    EXPECT_GT(bare, 0.01) << name;
    for (const std::vector<int>& opacities : std::vector<std::vector<int>>{
             {}, {2}, {1, 3}, {3, 2, 1}, {1, 2, 1, 3}, {2, 5}, {5, 1}, {1, 0, 2}}) {
      double part = 1;
      for (const int opacity : opacities) part *= 1 - opacity / 5.0;
      EXPECT_NEAR(light(add, opacities) / bare, part, 1e-3)
          << name << ", " << opacities.size() << " sheets, " << part;
    }
  };
  check("sun", add_sun, add_sun);
  check("bulb", add_bulb, add_bulb);
  check("lamp", add_lamp_and_sheet, add_lamp);
}

/// Blended leaves, some of which are opaque in places, under a stack of more sheets than a query
/// passes. The leaves' texture uses one of two sets of texture coordinates, which are equal.
Scene blended_leaves(std::uint32_t uv_set, bool double_sided, bool has_duplicates) {
  Scene scene = leaves(Holes::blended, double_sided);
  scene.images[0] = std::make_shared<const Image>(
      Image{.width = 2,
            .height = 1,
            .channels = 4,
            .samples = std::vector<std::uint8_t>{255, 255, 255, 255, 255, 255, 255, 90}});
  scene.materials[1].base_color_texture->uv_set = uv_set;
  for (int i = 0; i < 24; ++i) {
    Mesh sheet =
        parallelogram({-1, 3.6F + 0.02F * static_cast<float>(i), -1}, {2, 0, 0}, {0, 0, 2});
    sheet.uv_sets.push_back({{1, 0}, {1, 0}, {1, 1}, {1, 1}});
    scene.objects.push_back({.shape = sheet, .material = 1});
  }
  // Before the leaves, a one-sided surface whose back the camera doesn't see.
  scene.objects.push_back(
      {.shape = parallelogram({-2, 3.2F, 1}, {4, 0, 0}, {0, 0, 3}), .material = 3});
  scene.materials.push_back({.double_sided = false});
  for (std::size_t i = 2; has_duplicates && i < 9; ++i) scene.objects.push_back(scene.objects[i]);
  for (Object& object : scene.objects) {
    auto& uv_sets = std::get<Mesh>(object.shape).uv_sets;
    if (!uv_sets.empty()) uv_sets.push_back(uv_sets[0]);
  }
  return scene;
}

// Surfaces are shaded in vectors only if all texture coordinates are the first ones.
TEST(MaskedPaths, PassBlendedSurfacesTogetherAsOneByOne) {
  const PerspectiveCamera camera{.pose = {.position = {0, 5, 4},
                                          .direction = glm::normalize(DVec3(0, -1, -0.8)),
                                          .up = {0, 1, 0}}};
  for (const bool double_sided : {false, true}) {
    for (const bool has_duplicates : {false, true}) {
      for (const Backfaces backfaces : {Backfaces::pass, Backfaces::occlude}) {
        for (const std::uint32_t max_depth : {1U, 2U, 6U}) {
          const Shot shot{.size = {.width = 48, .height = 48},
                          .samples = 4,
                          .max_depth = max_depth,
                          .backfaces = backfaces};
          const auto picture = [&](std::uint32_t uv_set) {
            return shoot(blended_leaves(uv_set, double_sided, has_duplicates), camera, shot);
          };
          EXPECT_EQ(differing(picture(0), picture(1)), 0)
              << (double_sided ? "two" : "one") << " sides, duplicates " << has_duplicates
              << ", backfaces " << static_cast<int>(backfaces) << ", depth " << max_depth;
        }
      }
    }
  }
}

// The two sides of one-sided glass transmit different parts of the light, and alpha still counts.
TEST(MaskedPaths, PassOneSidedGlassByItsAlpha) {
  Scene scene;
  Material material{.base_color = {0, 0, 0, 0.25F},
                    .alpha_mode = AlphaMode::blend,
                    .double_sided = false,
                    .roughness = 0.5F};
  material.transmission = Transmission{.factor = 1};
  material.specular = Specular{.factor = 0};
  scene.materials = {material};
  scene.objects.push_back(
      {.shape = parallelogram({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), .material = 0});
  scene.objects.push_back(
      {.shape = parallelogram({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}), .material = 1});
  scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = Vec3(1)});
  scene.environment = Environment{.content = Vec3(0)};
  const OrthographicCamera camera{
      .pose = {.position = {0, 1, 0}, .direction = {0, -1, 0}, .up = {0, 0, 1}}, .height = 0.1};
  const Shot shot{.size = {.width = 8, .height = 8}, .samples = 256};
  EXPECT_NEAR(mean_of(shoot(scene, camera, shot)).y, 0.75, 0.01);
}

}  // namespace
}  // namespace microtrace
