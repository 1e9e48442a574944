#include "gltf/asset_builder.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Json perspective() {
  return {{"type", "perspective"}, {"perspective", {{"yfov", 0.75}, {"znear", 0.5}}}};
}

/// Returns the cube, and this camera on a new root node 1.
AssetBuilder with_camera(const Json& camera) {
  AssetBuilder asset = cube();
  asset.json["cameras"] = Json::array({camera});
  asset.json["nodes"].push_back({{"camera", 0}, {"name", "Eye"}});
  asset.json["scenes"][0]["nodes"].push_back(1);
  return asset;
}

TEST(GltfCamera, Perspective) {
  AssetBuilder asset = with_camera(perspective());
  asset.json["nodes"][1]["translation"] = {1, 2, 3};
  const LoadedScene loaded = load(asset);
  ASSERT_EQ(loaded.scene.cameras.size(), 1U);
  EXPECT_EQ(loaded.scene.cameras[0].name, "Eye");
  const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras[0].camera);
  EXPECT_EQ(camera.pose.position, DVec3(1, 2, 3));
  EXPECT_EQ(camera.pose.direction, DVec3(0, 0, -1));
  EXPECT_EQ(camera.pose.up, DVec3(0, 1, 0));
  EXPECT_EQ(camera.vertical_fov, 0.75);
  EXPECT_FALSE(camera.aspect_ratio.has_value());
  EXPECT_EQ(camera.depth.near, 0.5);
  EXPECT_EQ(camera.depth.far, std::numeric_limits<double>::infinity());
}

TEST(GltfCamera, PerspectiveWithAllProperties) {
  Json camera = perspective();
  camera["perspective"].update({{"aspectRatio", 1.5}, {"zfar", 100}});
  const LoadedScene loaded = load(with_camera(camera));
  const auto& found = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0).camera);
  EXPECT_EQ(found.aspect_ratio, 1.5);
  EXPECT_EQ(found.depth.far, 100);
}

TEST(GltfCamera, Orthographic) {
  const LoadedScene loaded =
      load(with_camera({{"type", "orthographic"},
                        {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}));
  const auto& camera = std::get<OrthographicCamera>(loaded.scene.cameras.at(0).camera);
  EXPECT_EQ(camera.height, 4);
  EXPECT_EQ(camera.aspect_ratio, 1.5);
  EXPECT_EQ(camera.depth.near, 0);
  EXPECT_EQ(camera.depth.far, 9);
}

TEST(GltfCamera, ScaleDoesNotDistort) {
  AssetBuilder asset = with_camera(perspective());
  asset.json["nodes"][1].update({{"scale", {3, 1e-5, 7}}, {"rotation", {0, 1, 0, 0}}});
  const LoadedScene loaded = load(asset);
  const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0).camera);
  EXPECT_EQ(camera.pose.direction, DVec3(0, 0, 1));
  EXPECT_EQ(camera.pose.up, DVec3(0, 1, 0));
}

TEST(GltfCamera, NamesAreUniqueAndInTreeOrder) {
  AssetBuilder asset = with_camera(perspective());
  asset.json["cameras"][0]["name"] = "Lens";
  asset.json["nodes"].push_back({{"camera", 0}});
  asset.json["nodes"].push_back({{"camera", 0}, {"name", "Eye"}, {"children", {4}}});
  asset.json["nodes"].push_back({{"camera", 0}, {"name", "Inner"}});
  asset.json["scenes"][0]["nodes"] = {3, 2, 1, 0};
  std::vector<std::string> names;
  for (const NamedCamera& camera : load(asset).scene.cameras) names.push_back(camera.name);
  EXPECT_THAT(names, ElementsAre("Eye", "Inner", "Lens", "Eye (2)"));
}

TEST(GltfCamera, ZeroScalesKeepTheOrientation) {
  AssetBuilder asset = with_camera(perspective());
  asset.json["nodes"][1].update({{"translation", {4, 5, 6}}, {"rotation", {1, 0, 0, 0}}});
  asset.json["nodes"].push_back(
      {{"children", {1}}, {"translation", {1, 2, 3}}, {"rotation", {0, 1, 0, 0}}});
  asset.json["scenes"][0]["nodes"] = {0, 2};
  for (const DVec3& scale : {DVec3(0), DVec3(1, 0, 1), DVec3(2, 3, 0)}) {
    asset.json["nodes"][2]["scale"] = {scale.x, scale.y, scale.z};
    const LoadedScene loaded = load(asset);
    EXPECT_THAT(texts(loaded.warnings), IsEmpty());
    const auto& pose = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0).camera).pose;
    EXPECT_EQ(pose.position, DVec3(1, 2, 3) + scale * DVec3(-4, 5, -6));
    EXPECT_EQ(pose.direction, DVec3(0, 0, -1)) << scale.x;
    EXPECT_EQ(pose.up, DVec3(0, -1, 0)) << scale.x;
  }
}

// The camera's axes lie in a plane, but -z and y are not parallel.
TEST(GltfCamera, FlatParentsKeepTheOrientation) {
  AssetBuilder asset = with_camera(perspective());
  asset.json["nodes"][1]["rotation"] = {0.5, 0.5, 0.5, 0.5};  // maps x to y, y to z, and z to x
  asset.json["nodes"].push_back({{"children", {1}}, {"rotation", {0.6, 0, 0, 0.8}}});
  asset.json["nodes"].push_back({{"children", {2}}});
  asset.json["scenes"][0]["nodes"] = {0, 3};
  for (const DVec3& scale : {DVec3(1, 0, 1), DVec3(1, 1, 0), DVec3(0, 1, 1)}) {
    asset.json["nodes"][3]["scale"] = {scale.x, scale.y, scale.z};
    const LoadedScene loaded = load(asset);
    EXPECT_THAT(texts(loaded.warnings), IsEmpty());
    const auto& pose = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0).camera).pose;
    EXPECT_NEAR(glm::distance(pose.direction, DVec3(-1, 0, 0)), 0, 1e-15);
    EXPECT_NEAR(glm::distance(pose.up, DVec3(0, -0.96, 0.28)), 0, 1e-15);
  }
}

TEST(GltfCamera, IgnoresCamerasWithoutOrientation) {
  AssetBuilder asset = with_camera(perspective());
  asset.json["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const LoadedScene loaded = load(asset);
  EXPECT_TRUE(loaded.scene.cameras.empty());
  EXPECT_THAT(texts(loaded.warnings), Contains(HasSubstr("/nodes/1/camera")));
}

}  // namespace
}  // namespace microtrace::tests
