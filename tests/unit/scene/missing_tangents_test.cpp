// Checks that tangents are generated exactly for the meshes that need them.

#include "scene/mesh/missing_tangents.hpp"

#include "base/memory_account.hpp"
#include "scene/mesh/tangents.hpp"

#include <microtrace/error.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns a square with one set of texture coordinates.
Mesh square() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.uv_sets = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  return mesh;
}

/// Returns a scene whose material 0 has a normal map, 1 anisotropy, and 2 neither.
Scene scene_of(Objects objects) {
  Scene scene;
  auto image = std::make_shared<Image>();
  *image = {.name = "",
            .width = 1,
            .height = 1,
            .channels = 3,
            .samples = std::vector<std::uint8_t>(3, 128)};
  scene.images = {image};
  scene.textures = {{.image = 0}};
  scene.materials = {
      {.normal_texture = TextureUse{}}, {.anisotropy = Anisotropy{.strength = 0.5F}}, {}};
  scene.objects = std::move(objects);
  return scene;
}

const Mesh& mesh_of(const Scene& scene, std::size_t object) {
  return std::get<Mesh>(scene.objects.first_of(object).shape);
}

TEST(MissingTangents, AreGeneratedForMaterialsThatNeedThem) {
  const PreparedScene prepared(scene_of({{.shape = square(), .material = 0},
                                         {.shape = square(), .material = 1},
                                         {.shape = square(), .material = 2},
                                         {.shape = square()},
                                         {.shape = Sphere{}, .material = 0}}));
  const Scene& scene = prepared.scene();
  Mesh expected = square();
  make_tangents(expected, 0);
  for (const std::size_t i : {0, 1}) {
    ASSERT_EQ(mesh_of(scene, i).tangents.size(), 4U) << i;
    for (std::size_t v = 0; v < 4; ++v)
      EXPECT_EQ(mesh_of(scene, i).tangents[v], expected.tangents[v]);
  }
  EXPECT_TRUE(mesh_of(scene, 2).tangents.empty());
  EXPECT_TRUE(mesh_of(scene, 3).tangents.empty());
}

TEST(MissingTangents, TheSceneIsNotCopiedWithoutNeed) {
  Mesh given = square(), bare = square(), distant = square();
  make_tangents(given, 0);
  bare.uv_sets.clear();
  distant.positions.edit()[2].x = INFINITY;
  Scene scene = scene_of({{.shape = given, .material = 0},
                          {.shape = bare, .material = 0},
                          {.shape = distant, .material = 1},
                          {.shape = square(), .material = 2}});
  scene.materials.push_back({.normal_texture = TextureUse{.texture = 1}});
  scene.textures.push_back({.image = 1});
  scene.images.push_back(nullptr);  // not loaded
  scene.objects.push_back({.shape = square(), .material = 3});
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  EXPECT_EQ(with_tangents(shared), shared);
}

TEST(MissingTangents, ObjectsThatShareArraysShareTangents) {
  Mesh mesh = square(), colored = mesh;
  colored.colors.assign(4, Vec4(0.5F));
  Scene scene = scene_of({{.shape = mesh, .material = 0}, {.shape = colored, .material = 0}});
  const Placement moved(glm::dmat4(2.0));
  scene.objects.push_back_run({.shape = mesh, .material = 0}, {moved, moved});
  const auto result = with_tangents(std::make_shared<const Scene>(std::move(scene)));
  ASSERT_EQ(result->objects.size(), 4U);
  EXPECT_EQ(result->objects.runs().size(), 3U);
  EXPECT_EQ(mesh_of(*result, 0).tangents.data(), mesh_of(*result, 3).tangents.data());
  EXPECT_FALSE(mesh_of(*result, 3).tangents.empty());
  EXPECT_EQ(mesh_of(*result, 1).colors.size(), 4U);
  EXPECT_TRUE(mesh_of(*result, 0).colors.empty());
}

TEST(MissingTangents, ArraysThatBeginAlikeAreDifferent) {
  const Mesh mesh = square();
  Mesh part = mesh, whole = mesh;
  part.triangles = Array<std::array<std::uint32_t, 3>>::borrow(std::span(mesh.triangles.data(), 1));
  whole.triangles =
      Array<std::array<std::uint32_t, 3>>::borrow(std::span(mesh.triangles.data(), 2));
  for (const bool reversed : {false, true}) {
    const PreparedScene prepared(scene_of({{.shape = reversed ? whole : part, .material = 0},
                                           {.shape = reversed ? part : whole, .material = 0}}));
    EXPECT_EQ(mesh_of(prepared.scene(), reversed ? 0 : 1).triangles.size(), 2U);
    EXPECT_EQ(mesh_of(prepared.scene(), reversed ? 1 : 0).triangles.size(), 1U);
  }
}

TEST(MissingTangents, MemoryIsLimited) {
  MemoryBudget budget(100);
  EXPECT_THROW(
      (void)PreparedScene(scene_of({{.shape = square(), .material = 0}}), {.memory = &budget}),
      Error);
}

}  // namespace
}  // namespace microtrace
