#include <microtrace/render.hpp>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr Vec3 kBackground{0.5F, 0.25F, 1};

/// Squares at z = -1, -2, ... in order of creation, in front of the camera's only pixel. Their
/// vertices are counterclockwise as seen from the camera.
struct Stack {
  Scene scene;
  float z = 0;

  Stack() { scene.background = kBackground; }

  Mesh& add(const Material& material) {
    z -= 1;
    Mesh mesh;
    mesh.positions = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.materials.push_back(material);
    scene.objects.push_back({.name = "square",
                             .shape = mesh,
                             .material = static_cast<std::uint32_t>(scene.materials.size() - 1)});
    return std::get<Mesh>(scene.objects.back().shape);
  }

  [[nodiscard]] Vec3 pixel() const { return film().row(0)[0]; }
  [[nodiscard]] Film film(bool transparent = false) const {
    return render(scene, PerspectiveCamera{}, {.width = 1, .height = 1},
                  {.threads = 1, .transparent = transparent});
  }
};

Material blend(const Vec4& color) {
  return {.base_color = color, .alpha_mode = AlphaMode::blend};
}

TEST(Flat, OpaqueIgnoresAlpha) {
  Stack stack;
  stack.add({.base_color = {1, 0, 0, 0.25F}});
  EXPECT_EQ(stack.pixel(), Vec3(1, 0, 0));
}

TEST(Flat, MaskDrawsAllOrNothing) {
  Stack stack;
  stack.add({.base_color = {1, 0, 0, 0.5F}, .alpha_mode = AlphaMode::mask});
  stack.add({.base_color = {0, 1, 0, 1}});
  EXPECT_EQ(stack.pixel(), Vec3(1, 0, 0)) << "the cutoff itself is drawn";
  stack.scene.materials[0].alpha_cutoff = 0.51F;
  EXPECT_EQ(stack.pixel(), Vec3(0, 1, 0));
  stack.scene.materials[1].alpha_mode = AlphaMode::mask;
  stack.scene.materials[1].alpha_cutoff = 1.5F;
  EXPECT_EQ(stack.pixel(), kBackground);
}

TEST(Flat, BlendingIsInDepthOrder) {
  Stack stack;
  stack.add(blend({1, 0, 0, 0.5F}));
  stack.add(blend({0, 1, 0, 0.5F}));
  EXPECT_EQ(stack.pixel(), Vec3(0.5F, 0.25F, 0) + 0.25F * kBackground);
  std::swap(stack.scene.objects[0], stack.scene.objects[1]);
  EXPECT_EQ(stack.pixel(), Vec3(0.5F, 0.25F, 0) + 0.25F * kBackground) << "not that of the file";
  std::swap(stack.scene.materials[0], stack.scene.materials[1]);
  EXPECT_EQ(stack.pixel(), Vec3(0.25F, 0.5F, 0) + 0.25F * kBackground);
}

TEST(Flat, BlendingEndsAtOpaqueSurfaces) {
  Stack stack;
  stack.add(blend({1, 0, 0, 0.5F}));
  stack.add({.base_color = {0, 0, 1, 1}});
  stack.add(blend({0, 1, 0, 0.5F}));
  EXPECT_EQ(stack.pixel(), Vec3(0.5F, 0, 0.5F));
}

TEST(Flat, BlendedSurfacesInOnePlaneAllCount) {
  Stack stack;
  stack.add(blend({1, 0, 0, 0.5F}));
  stack.z += 1;
  stack.add(blend({0, 1, 0, 0.5F}));
  EXPECT_EQ(stack.pixel(), Vec3(0.5F, 0.25F, 0) + 0.25F * kBackground);
}

TEST(Flat, SharedEdgesAreOneSurface) {
  // The pixel's ray passes through each square's diagonal, which counts as one layer. The two sides
  // of a wedge count as two layers.
  Stack stack;
  Mesh& mesh = stack.add(blend({1, 0, 0, 0.5F}));
  EXPECT_EQ(stack.pixel(), Vec3(0.5F, 0, 0) + 0.5F * kBackground);
  for (std::size_t i = 0; i < 4; ++i) mesh.positions.push_back(mesh.positions[i]);
  mesh.triangles.edit()[1] = {4, 6, 7};
  EXPECT_EQ(stack.pixel(), Vec3(0.5F, 0, 0) + 0.5F * kBackground) << "with a seam";
  mesh.positions = {{-9, 0, -1}, {9, 0, -1}, {0, 9, -5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_EQ(stack.pixel(), Vec3(0.75F, 0, 0) + 0.25F * kBackground);
}

TEST(Flat, LayersThatMeetAtAVertexAreTwo) {
  // The pixel's ray hits the triangles at 1 and 1 + 2^-26, which both round to 1.
  Stack stack;
  Mesh& mesh = stack.add(blend({1, 0, 0, 0.5F}));
  const float behind = -1 - 0x1p-23F;
  mesh.positions = {{-1, 0, -1}, {7, -8, -1}, {7, 8, -1}, {7, -8, behind}, {7, 8, behind}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(stack.pixel(), Vec3(0.75F, 0, 0) + 0.25F * kBackground);
}

TEST(Flat, BlendGivesTheFilmAlpha) {
  Stack stack;
  stack.add(blend({1, 0.5F, 0, 0.75F}));
  Film film = stack.film(true);
  EXPECT_EQ(film.at(0, 0), Vec3(0.75F, 0.375F, 0));
  EXPECT_EQ(film.alpha_at(0, 0), 0.75F);
}

TEST(Flat, ManyTransparentLayersTerminate) {
  Stack stack;
  for (int i = 0; i < 200; ++i) stack.add(blend({1, 1, 1, 0.5F}));
  EXPECT_EQ(stack.pixel(), Vec3(1));
}

TEST(Flat, BacksAreDrawnOnlyOfDoubleSidedMaterials) {
  Stack stack;
  stack.add({.base_color = {1, 0, 0, 1}, .double_sided = false});
  stack.add({.base_color = {0, 1, 0, 1}});
  EXPECT_EQ(stack.pixel(), Vec3(1, 0, 0));
  for (auto& corners : std::get<Mesh>(stack.scene.objects[0].shape).triangles.edit())
    std::swap(corners[0], corners[1]);
  EXPECT_EQ(stack.pixel(), Vec3(0, 1, 0));
  stack.scene.materials[0].double_sided = true;
  EXPECT_EQ(stack.pixel(), Vec3(1, 0, 0));
}

TEST(Flat, SpheresWithoutABackShowTheirFront) {
  Stack stack;
  stack.add({.base_color = {0, 1, 0, 1}});
  stack.scene.objects.push_back(
      {.name = "around", .shape = Sphere{{0, 0, 0}, 0.5F}, .material = 1});
  stack.scene.materials.push_back({.base_color = {1, 0, 0, 1}, .double_sided = false});
  EXPECT_EQ(stack.pixel(), Vec3(0, 1, 0));
  stack.scene.objects.back().shape = Sphere{{0, 0, -0.5F}, 0.25F};
  EXPECT_EQ(stack.pixel(), Vec3(1, 0, 0));
}

TEST(Flat, VertexColorsAreFactors) {
  Stack stack;
  Mesh& mesh = stack.add({.base_color = {0.5F, 1, 1, 1}});
  mesh.colors.assign(4, {1, 0.25F, 0.5F, 0.5F});
  EXPECT_EQ(stack.pixel(), Vec3(0.5F, 0.25F, 0.5F));
  stack.scene.materials[0].alpha_mode = AlphaMode::mask;
  stack.scene.materials[0].alpha_cutoff = 0.75F;
  EXPECT_EQ(stack.pixel(), kBackground);
}

}  // namespace
}  // namespace microtrace
