#include "gltf/asset_builder.hpp"
#include "io/gltf/scene/scene.hpp"

#include <cmath>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Returns the triangle (0, 0, 0), (1, 0, 0), (0, 2, 0) on node 0.
AssetBuilder triangle() {
  AssetBuilder asset;
  asset.add_object(
      {{"attributes",
        {{"POSITION", asset.add_positions({Vec3(0), Vec3(1, 0, 0), Vec3(0, 2, 0)})}}}});
  return asset;
}

std::vector<std::array<Vec3, 3>> first_object(const LoadedScene& loaded) {
  return triangles_of(loaded.scene.objects.at(0));
}

TEST(GltfNode, ScaleThenRotationThenTranslation) {
  AssetBuilder asset = triangle();
  const double half = std::sqrt(0.5);
  asset.json["nodes"][0].update({{"translation", {10, 20, 30}},
                                 {"rotation", {0, 0, half, half}},  // rotates x to y and y to -x
                                 {"scale", {2, 3, 4}}});
  const auto triangles = first_object(load(asset));
  ASSERT_EQ(triangles.size(), 1U);
  EXPECT_EQ(triangles[0][0], Vec3(10, 20, 30));
  EXPECT_EQ(triangles[0][1], Vec3(10, 22, 30));
  EXPECT_EQ(triangles[0][2], Vec3(4, 20, 30));
}

TEST(GltfNode, MatrixIsColumnMajorAndEqualsItsDecomposition) {
  AssetBuilder parts = triangle();
  // The unit quaternion (1, 1, 1, 1) / 2 rotates x to y, y to z, and z to x.
  parts.json["nodes"][0].update({{"translation", {0.1, -7, 1e5}},
                                 {"rotation", {0.5, 0.5, 0.5, 0.5}},
                                 {"scale", {0.3, 2, -5}}});
  AssetBuilder matrix = triangle();
  matrix.json["nodes"][0]["matrix"] = {0, 0.3, 0, 0, 0, 0, 2, 0, -5, 0, 0, 0, 0.1, -7, 1e5, 1};
  EXPECT_EQ(first_object(load(parts)), first_object(load(matrix)));
  // The negative scale mirrors the triangle, so vertices 1 and 2 are swapped.
  EXPECT_EQ(first_object(load(matrix))[0][2], Vec3(0.1F, static_cast<float>(-7 + 0.3), 1e5F));
}

TEST(GltfNode, HierarchyIsComposedInDoubleAndRoundedOnce) {
  AssetBuilder asset = triangle();
  // Two large translations cancel. In float32, the remaining 0.125 would be lost.
  asset.json["nodes"][0]["translation"] = {-1e9, 0.125, 0};
  asset.json["nodes"].push_back(
      {{"children", {0}}, {"translation", {1e9 + 0.125, 0, 0}}, {"name", "above"}});
  asset.json["nodes"].push_back({{"children", {1}}, {"scale", {2, 2, 2}}, {"name", "top"}});
  asset.json["scenes"][0]["nodes"] = {2};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(
      first_object(loaded),
      ElementsAre(std::array{Vec3(0.25F, 0.25F, 0), Vec3(2.25F, 0.25F, 0), Vec3(0.25F, 4.25F, 0)}));
  EXPECT_EQ(loaded.scene.objects[0].name, "top/above/node0/mesh0");
}

// At a distance of 6 000 km, float32 numbers are half a meter apart.
TEST(GltfNode, DistanceFromTheOriginCostsNoPrecision) {
  AssetBuilder asset = triangle();
  const DVec3 far(-2694044.4111565403, -4266368.805493665, 3888310.602231939);
  asset.json["nodes"][0]["translation"] = {far.x, far.y, far.z};
  asset.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  asset.json["nodes"].push_back({{"camera", 0}, {"translation", {far.x, far.y + 1, far.z + 4}}});
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  asset.json["extensionsUsed"] = {"KHR_lights_punctual"};
  asset.json["nodes"].push_back({{"translation", {far.x + 2, far.y, far.z}},
                                 {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  asset.json["scenes"][0]["nodes"] = {0, 1, 2};
  const std::string bytes = asset.embedded();
  const Scene scene = io::GltfFile(bytes, "test.gltf", "nowhere").at(std::nullopt).scene;
  const auto expect_there = [&](const DVec3& p, const DVec3& expected) {
    EXPECT_LT(glm::distance(p + scene.origin, far + expected), 1e-6);
  };
  const auto triangle = triangles_of(scene.objects.at(0)).at(0);
  expect_there(DVec3(triangle[0]), {0, 0, 0});
  expect_there(DVec3(triangle[1]), {1, 0, 0});
  expect_there(DVec3(triangle[2]), {0, 2, 0});
  expect_there(std::get<PerspectiveCamera>(scene.cameras.at(0).camera).pose.position, {0, 1, 4});
  expect_there(std::get<PointLight>(scene.lights.at(0).light).position, {2, 0, 0});
}

TEST(GltfNode, LargeScenesAreNotTranslated) {
  AssetBuilder asset = triangle();
  asset.json["nodes"][0]["translation"] = {15, 0, 0};
  std::string bytes = asset.embedded();
  EXPECT_EQ(io::GltfFile(bytes, "test.gltf", "nowhere").at(std::nullopt).scene.origin, DVec3(0));
  asset.json["nodes"][0]["translation"] = {1e6, 0, 0};
  asset.json["nodes"][0]["scale"] = {1, 1e6, 1};
  bytes = asset.embedded();
  EXPECT_EQ(io::GltfFile(bytes, "test.gltf", "nowhere").at(std::nullopt).scene.origin, DVec3(0));
}

TEST(GltfNode, MirroringReversesTheWinding) {
  AssetBuilder asset = triangle();
  asset.json["nodes"][0]["scale"] = {-1, 1, 1};
  EXPECT_THAT(first_object(load(asset)),
              ElementsAre(std::array{Vec3(0), Vec3(0, 2, 0), Vec3(-1, 0, 0)}));
  asset.json["nodes"][0]["scale"] = {-1, -1, 1};
  EXPECT_THAT(first_object(load(asset)),
              ElementsAre(std::array{Vec3(0), Vec3(-1, 0, 0), Vec3(0, -2, 0)}));
}

TEST(GltfNode, TheCallersTransformIsAppliedLast) {
  DMat4 world_from_asset(2);
  world_from_asset[3] = {100, 0, 0, 1};
  const LoadedScene loaded = load_gltf(triangle().embedded(), "test.gltf", "", world_from_asset);
  EXPECT_THAT(first_object(loaded),
              ElementsAre(std::array{Vec3(100, 0, 0), Vec3(102, 0, 0), Vec3(100, 4, 0)}));
}

TEST(GltfNode, RotationsAreNormalizedWithAWarningBeyondTolerance) {
  AssetBuilder asset = triangle();
  asset.json["nodes"][0]["rotation"] = {0, 0, 0.7071068, 0.7071068};
  EXPECT_THAT(texts(load(asset).warnings), IsEmpty());
  asset.json["nodes"][0]["rotation"] = {0, 0, 0.5, 0.5};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("/nodes/0/rotation")));
  EXPECT_NEAR(first_object(loaded)[0][1].y, 1, 1e-7);
}

TEST(GltfNode, OnlyTheDefaultSceneIsDrawn) {
  AssetBuilder asset = triangle();
  asset.json["nodes"][0]["name"] = "first";
  asset.json["nodes"].push_back({{"mesh", 0}, {"name", "second"}});
  asset.json["scenes"].push_back({{"nodes", {1}}});
  asset.json["scene"] = 1;
  ASSERT_EQ(load(asset).scene.objects.size(), 1U);
  EXPECT_EQ(load(asset).scene.objects[0].name, "second/mesh0");
  asset.json.erase("scene");
  EXPECT_EQ(load(asset).scene.objects.at(0).name, "first/mesh0");
  EXPECT_THAT(texts(load(asset).warnings), IsEmpty());
  asset.json.erase("scenes");
  EXPECT_EQ(load(asset).scene.objects.size(), 2U);
  EXPECT_THAT(texts(load(asset).warnings), ElementsAre(HasSubstr("no scene")));
}

TEST(GltfNode, ObjectsAreInTreeOrderWithUniqueNames) {
  AssetBuilder asset = triangle();
  asset.json["meshes"][0]["name"] = "leaf";
  asset.json["nodes"] = {{{"name", "a"}, {"children", {2, 1}}, {"mesh", 0}},
                         {{"name", "b"}, {"mesh", 0}},
                         {{"name", "b"}, {"mesh", 0}},
                         {{"name", "a/b"}, {"mesh", 0}}};
  asset.json["scenes"][0]["nodes"] = {3, 0};
  std::vector<std::string> names;
  for (const Object& object : load(asset).scene.objects) names.push_back(object.name.str());
  EXPECT_THAT(names, ElementsAre("a/b/leaf", "a/leaf", "a/b/leaf (2)", "a/b/leaf (3)"));
}

TEST(GltfNode, EachPrimitiveIsAnObject) {
  AssetBuilder asset = triangle();
  Json& primitives = asset.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] =
      asset.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 0.5}}}}});
  const LoadedScene loaded = load(asset);
  ASSERT_EQ(loaded.scene.objects.size(), 2U);
  EXPECT_EQ(loaded.scene.objects[0].name, "node0/mesh0:0");
  EXPECT_EQ(loaded.scene.objects[1].name, "node0/mesh0:1");
  EXPECT_EQ(color_of(loaded, 0), Vec4(1));
  EXPECT_EQ(color_of(loaded, 1), Vec4(0, 1, 0, 0.5F));
}

TEST(GltfNode, ReadsDeepTrees) {
  AssetBuilder asset = triangle();
  constexpr int kDepth = 100000;
  Json nodes = Json::array();
  for (int i = 0; i < kDepth; ++i)
    nodes.push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  asset.json["nodes"] = nodes;
  const LoadedScene loaded = load(asset);
  EXPECT_EQ(first_object(loaded)[0][0], Vec3(kDepth, 0, 0));
  EXPECT_LE(loaded.scene.objects[0].name.str().size(), 300U);
}

}  // namespace
}  // namespace microtrace::tests
