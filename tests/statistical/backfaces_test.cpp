/// Tests light at the backs of one-sided surfaces.
#include "support/pictures.hpp"
#include "support/shading/bodies.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr std::uint32_t kMatt = 0, kHull = 1, kLamp = 2;

/// Returns a box of triangles whose fronts face inward if `faces_inwards` is true, otherwise
/// outward.
Mesh box(const Vec3& center, const Vec3& half, bool faces_inwards) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      Vec3 u(0), v(0), w(0);
      u[axis] = side * half[axis];
      v[(axis + 1) % 3] = half[(axis + 1) % 3];
      w[(axis + 2) % 3] = half[(axis + 2) % 3];
      if ((side > 0) == faces_inwards) std::swap(v, w);
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const Vec3& p : {u - v - w, u + v - w, u + v + w, u - v + w})
        mesh.positions.push_back(center + p);
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
  return mesh;
}

/// A diffuse, one-sided box of half width 1, whose top the camera sees. A one-sided hull may be
/// added around it.
struct Model {
  Model() {
    scene.materials = {{.base_color = {0.6F, 0.6F, 0.6F, 1}, .double_sided = false, .roughness = 1},
                       {.base_color = {0, 0, 0, 1}, .double_sided = false, .unlit = true},
                       {.base_color = {0, 0, 0, 1}, .emissive = Vec3(4)}};
    scene.environment = Environment{.content = Vec3(0)};
    add(box({0, 0, 0}, Vec3(1), false), kMatt);
  }
  void add(Shape shape, std::uint32_t material) {
    scene.objects.push_back({.name = "object", .shape = std::move(shape), .material = material});
  }
  void add_hull() { add(box({0, 0, 0}, Vec3(1.25F), true), kHull); }
  void add_light(const Light& light) { scene.lights.push_back({.name = "light", .light = light}); }

  [[nodiscard]] Estimate seen(Backfaces backfaces, std::uint32_t max_depth = 2) const {
    return estimate(scene, camera,
                    {.size = {.width = 4, .height = 4},
                     .samples = 64,
                     .max_depth = max_depth,
                     .backfaces = backfaces},
                    16);
  }

  Scene scene;
  OrthographicCamera camera{
      .pose = {.position = {0.1, 2, 0.1}, .direction = {0, -1, 0}, .up = {0, 0, -1}},
      .height = 0.5};
};

/// Returns models without a hull, each lit by a different kind of light.
std::array<std::pair<std::string, Model>, 8> lit_models() {
  std::array<std::pair<std::string, Model>, 8> models;
  std::size_t i = 0;
  const auto next = [&](const char* name) -> Model& {
    models[i].first = name;
    return models[i++].second;
  };
  next("uniform").scene.environment = Environment{.content = Vec3(1)};
  next("studio").scene.environment = Environment{.content = Studio{}};
  next("sun").add_light(DirectionalLight{.direction = {0.6, -0.8, 0}, .intensity = 3});
  next("point").add_light(PointLight{.position = {1, 3, 0}, .intensity = 9});
  next("spot").add_light(
      SpotLight{.position = {0, 3, 0}, .direction = {0, -1, 0}, .intensity = 9, .outer_angle = 1});
  next("ball").add(Sphere{{1, 4, 0}, 1}, kLamp);
  next("panel").add(box({-1, 3, 0}, {0.5F, 0.1F, 0.5F}, false), kLamp);
  Model& two = next("one-sided panel");
  two.scene.materials[kLamp].double_sided = false;
  two.scene.environment->content = Vec3(0.2F);
  two.add(box({-1, 3, 0}, {0.5F, 0.1F, 0.5F}, false), kLamp);
  return models;
}

// Light must pass through surfaces that are invisible to the camera. Both shadow rays and paths are
// tested, combined by multiple importance sampling.
TEST(Backfaces, HullsDoNotBlockLight) {
  for (auto& [name, model] : lit_models()) {
    const Estimate bare = model.seen(Backfaces::pass);
    EXPECT_GT(bare.mean, 0.05) << name;
    model.add_hull();
    const Estimate transmittance = model.seen(Backfaces::pass);
    EXPECT_NEAR(transmittance.mean, bare.mean,
                5 * (bare.deviation + transmittance.deviation) + 0.002 * bare.mean)
        << name;
    EXPECT_EQ(model.seen(Backfaces::occlude).mean, 0) << name;
  }
}

// A medium absorbs light on its whole way, also before an open front lets it in.
TEST(Backfaces, MediaAbsorbLightBeyondOpenFronts) {
  Model model;
  Material water = glass_body(Vec3(0.6F), 0);
  water.ior = 1.33F;
  model.scene.materials.push_back(water);
  model.scene.objects.push_back({.name = "water",
                                 .shape = Plane{.point = {0, 7, 0}, .normal = {0, 1, 0}},
                                 .material = kLamp + 1});
  model.add(box({-2, 3, 0}, {1.5F, 0.1F, 3}, false), kLamp);
  model.camera.pose.position.y = 8;
  const Estimate bare = model.seen(Backfaces::pass, 3);
  EXPECT_GT(bare.mean, 0.001);
  model.add(parallelogram({-4, 2, -4}, {3.5F, 0, 0}, {0, 0, 8}), kHull);  // its front is below
  const Estimate behind = model.seen(Backfaces::pass, 3);
  EXPECT_NEAR(behind.mean, bare.mean, 5 * (bare.deviation + behind.deviation) + 0.002 * bare.mean);
}

// Queries of rays return only the first hit with a sphere or a quadric, so its front must block
// light that its back would let in.
TEST(Backfaces, ClosedShapesCastShadows) {
  const Vec3 center(-1.7F, 3.4F, 0.1F);  // toward the sun
  const Quadric ball{.a = 1,
                     .b = 1,
                     .c = 1,
                     .g = -2 * center.x,
                     .h = -2 * center.y,
                     .i = -2 * center.z,
                     .j = glm::dot(center, center) - 0.64F};
  for (const Shape& shape : {Shape{Sphere{center, 0.8F}}, Shape{ball}}) {
    Model model;
    model.add_light(DirectionalLight{.direction = {0.6, -0.8, 0}, .intensity = 3});
    EXPECT_GT(model.seen(Backfaces::pass).mean, 0.05);
    model.add(shape, kMatt);
    EXPECT_EQ(model.seen(Backfaces::pass).mean, 0);
    EXPECT_EQ(model.seen(Backfaces::occlude).mean, 0);
  }
}

TEST(Backfaces, BacksOfUnlitHullsAreNotEmissive) {
  Model model;
  model.scene.materials[kHull].base_color = Vec4(1);
  model.camera.pose.position.y = 1.5;
  model.add(box({0, 3, 0}, Vec3(0.5F), true), kHull);
  EXPECT_EQ(model.seen(Backfaces::pass).mean, 0);
  model.scene.materials[kHull].double_sided = true;
  EXPECT_GT(model.seen(Backfaces::pass).mean, 0.01);
}

// A factor of 0 makes an extension for transmission ineffective.
TEST(Backfaces, SurfacesWithoutTransmissionCastShadows) {
  for (const bool has_extension : {false, true}) {
    Model model;
    if (has_extension) model.scene.materials[kMatt].transmission = Transmission{.factor = 0};
    model.add_light(DirectionalLight{.direction = {0, -1, 0}, .intensity = 3});
    model.camera.pose.position.y = 1.2;
    model.add(box({0, 2, 0}, Vec3(0.5F), false), kMatt);
    EXPECT_EQ(model.seen(Backfaces::pass).mean, 0);
  }
}

// Tests two nested hulls, one of which is blended.
TEST(Backfaces, HullsOfHulls) {
  Model model;
  model.scene.environment = Environment{.content = Studio{}};
  const Estimate bare = model.seen(Backfaces::pass);
  model.add_hull();
  model.scene.materials.push_back({.base_color = {1, 1, 1, 0.4F},
                                   .alpha_mode = AlphaMode::blend,
                                   .double_sided = false,
                                   .unlit = true});
  model.add(box({0, 0, 0}, Vec3(1.5F), true), 3);
  const Estimate transmittance = model.seen(Backfaces::pass);
  EXPECT_NEAR(transmittance.mean, bare.mean, 5 * (bare.deviation + transmittance.deviation));
}

// The camera is inside a room whose walls face inward.
TEST(Backfaces, RoomUnderASun) {
  Model model;
  model.scene.objects.clear();
  model.add(box({0, 1, 0}, Vec3(2), true), kMatt);
  model.add_light(DirectionalLight{.direction = {0.6, -0.8, 0}, .intensity = 10});
  EXPECT_EQ(model.seen(Backfaces::occlude).mean, 0);
  // The expected value is the diffuse part of a dielectric with f0 = 0.04. The tolerance allows for
  // a small specular part.
  EXPECT_NEAR(model.seen(Backfaces::pass).mean, 0.6 * 0.96 * 8 / 3.1416, 0.1);
}

// If light passes through a wall, the wall does not reflect it too, so no room is brighter than the
// environment.
TEST(Backfaces, WhiteRoomInWhiteLight) {
  Model model;
  model.scene.objects.clear();
  model.scene.materials[kMatt] = {.base_color = Vec4(1), .double_sided = false, .roughness = 1};
  model.scene.environment = Environment{.content = Vec3(1)};
  model.add(box({0, 1, 0}, Vec3(2), true), kMatt);
  EXPECT_NEAR(model.seen(Backfaces::pass, 32).mean, 1, 0.004);
  model.add(box({0.5F, 0, 0}, {0.2F, 0.5F, 0.2F}, false), kMatt);
  EXPECT_NEAR(model.seen(Backfaces::pass, 32).mean, 1, 0.01);
}

// A sheet above the box must cast a shadow on it if the sheet's front faces the light.
TEST(Backfaces, SheetsCastShadowsOfTheirFronts) {
  Model model;
  model.add_light(DirectionalLight{.direction = {0, -1, 0}, .intensity = 3});
  model.camera.pose.position.y = 1.5;
  const double lit = model.seen(Backfaces::pass).mean;
  Mesh sheet = box({0, 2, 0}, {3, 0, 3}, false);
  sheet.triangles = {sheet.triangles[6], sheet.triangles[7]};  // keeps only the upper side
  model.add(sheet, kMatt);
  EXPECT_EQ(model.seen(Backfaces::pass).mean, 0);
  EXPECT_EQ(model.seen(Backfaces::occlude).mean, 0);
  for (auto& triangle : sheet.triangles.edit()) std::swap(triangle[1], triangle[2]);
  model.scene.objects.back().shape = sheet;
  EXPECT_NEAR(model.seen(Backfaces::pass).mean, lit, 1e-6);
  EXPECT_EQ(model.seen(Backfaces::occlude).mean, 0);
}

/// Expects the same picture and the same number of rays for both values of Backfaces.
void expect_same(const Scene& scene, const Camera& camera) {
  std::array<std::vector<DVec3>, 2> pixels;
  std::array<RayCounts, 2> rays;
  for (std::size_t i = 0; i < 2; ++i) {
    const PathIntegrator path(
        {.max_depth = 16, .backfaces = i == 0 ? Backfaces::pass : Backfaces::occlude});
    pixels[i] = pixels_of(render(scene, camera, {.width = 16, .height = 16},
                                 {.threads = 1, .integrator = &path, .samples = 16}));
    rays[i] = path.ray_counts();
  }
  EXPECT_EQ(pixels[0], pixels[1]);
  EXPECT_EQ(rays[0].camera.rays, rays[1].camera.rays);
  EXPECT_EQ(rays[0].path.rays, rays[1].path.rays);
  EXPECT_EQ(rays[0].shadow.rays, rays[1].shadow.rays);
  EXPECT_EQ(rays[0].beyond, rays[1].beyond);
}

// Surfaces that enclose a medium always have a back, and the backs of thin panes transmit light.
// Both values therefore give the same picture.
TEST(Backfaces, GlassIsTheSame) {
  for (const bool is_body : {true, false}) {
    Model model;
    model.scene.environment = Environment{.content = Studio{}};
    model.scene.materials[kMatt].double_sided = true;
    Material glass{.base_color = {0.9F, 0.95F, 1, 1}, .double_sided = false, .roughness = 0};
    glass.transmission.emplace().factor = 1;
    if (is_body) {
      glass.volume.emplace().thickness = 1;
      glass.ior = 1.5F;
    }
    model.scene.materials.push_back(glass);
    model.add(box({0, 1.5F, 0}, Vec3(0.25F), false), 3);
    model.camera.pose.position.y = 3;
    model.camera.height = 2;
    expect_same(model.scene, model.camera);
  }
}

/// Returns one-sided rooms and boxes of the material kMatt: a room that the camera is in, a box
/// between the light and what the camera sees, and the same inside a box that is closed from
/// outside.
std::array<Model, 3> one_sided_models() {
  Model room;
  room.scene.objects.clear();
  room.scene.environment = Environment{.content = Studio{}};
  room.add(box({0, 1, 0}, Vec3(2), true), kMatt);
  room.add(box({0.5F, 0, 0}, {0.2F, 0.5F, 0.2F}, false), kMatt);
  room.add_light(DirectionalLight{.direction = {0.6, -0.8, 0}, .intensity = 10});
  Model shadow;
  shadow.add(box({0, 2, 0}, Vec3(0.5F), false), kMatt);
  shadow.camera.pose.position.y = 1.2;
  shadow.add_light(DirectionalLight{.direction = {0, -1, 0}, .intensity = 3});
  Model interior = shadow;
  interior.add(box({0, 0, 0}, Vec3(3), false), kMatt);
  return {room, shadow, interior};
}

/// Expects that surfaces with a texture of this texel look like surfaces without one.
void expect_same_pixels(Model model, const Material& textured, const Material& plain,
                        std::uint8_t texel) {
  const auto pixels = [&](const Material& material, Backfaces backfaces) {
    model.scene.materials[kMatt] = material;
    const Shot shot{.samples = 8, .max_depth = 8, .backfaces = backfaces};
    return pixels_of(shoot(model.scene, model.camera, shot));
  };
  model.scene.images = {std::make_shared<const Image>(
      Image{.width = 1, .height = 1, .channels = 4, .samples = std::vector(4, texel)})};
  model.scene.textures = {{.image = 0}};
  for (const Backfaces backfaces : {Backfaces::pass, Backfaces::occlude})
    EXPECT_EQ(pixels(textured, backfaces), pixels(plain, backfaces)) << int{texel};
}

// Where the texture is 0, a surface with transmission is opaque. Where it is 1, it is glass.
TEST(Backfaces, TransmissionTexturesSelectOpaqueParts) {
  for (const Model& model : one_sided_models()) {
    Material plain = model.scene.materials[kMatt], textured = plain;
    textured.transmission = Transmission{.factor = 1, .texture = TextureUse{}};
    expect_same_pixels(model, textured, plain, 0);
    plain.transmission = Transmission{.factor = 1};
    expect_same_pixels(model, textured, plain, 255);
  }
}

// The same with paper instead of glass, and with both.
TEST(Backfaces, DiffuseTransmissionTexturesSelectOpaqueParts) {
  for (const Model& model : one_sided_models()) {
    const Material opaque = model.scene.materials[kMatt];
    Material paper = opaque, textured = opaque;
    paper.diffuse_transmission = DiffuseTransmission{.factor = 0.7F};
    textured.diffuse_transmission = DiffuseTransmission{.factor = 0.7F, .texture = TextureUse{}};
    expect_same_pixels(model, textured, opaque, 0);
    expect_same_pixels(model, textured, paper, 255);
    Material none = opaque;
    none.diffuse_transmission = DiffuseTransmission{.factor = 0};
    expect_same_pixels(model, none, opaque, 255);
    textured.transmission = Transmission{.factor = 1, .texture = TextureUse{}};
    expect_same_pixels(model, textured, opaque, 0);
    textured.diffuse_transmission->texture.reset();
    expect_same_pixels(model, textured, paper, 0);
  }
}

TEST(Backfaces, TwoSidedSurfacesCostNothing) {
  Model model;
  model.scene.environment = Environment{.content = Studio{}};
  for (Material& material : model.scene.materials) material.double_sided = true;
  model.add_light(PointLight{.position = {1, 3, 0}, .intensity = 9});
  model.add(box({0.3F, 1.3F, 0}, Vec3(0.2F), false), kMatt);
  expect_same(model.scene, model.camera);
}

}  // namespace
}  // namespace microtrace
