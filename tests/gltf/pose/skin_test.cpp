#include "gltf/asset_builder.hpp"
#include "io/gltf/scene/scene.hpp"

#include <cmath>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Mesh posed_mesh(const LoadedScene& loaded) {
  return std::get<Mesh>(loaded.scene.objects.at(0).shape);
}

void expect_near(const Array<Vec3>& values, const std::vector<Vec3>& wanted) {
  ASSERT_EQ(values.size(), wanted.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(values[i][k], wanted[i][k], 1e-6) << i << ' ' << k;
  }
}

const double half = std::sqrt(0.5);

/// Returns an arm in the plane z = 0, along x from 0 to 2. The shoulder (node 1) is at x = 0 and
/// moves the vertices there. The elbow (node 2) is at x = 1 and moves the vertices at x = 2. The
/// vertices at x = 1 have equal weights for both joints. Node 0 has the mesh.
template <typename Joint = std::uint8_t>
AssetBuilder arm() {
  AssetBuilder asset;
  const std::size_t positions = asset.add_positions({Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(1, -1, 0),
                                                     Vec3(1, 1, 0), Vec3(2, -1, 0), Vec3(2, 1, 0)});
  const std::size_t normals =
      asset.add_numbers<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0});
  const std::size_t joints = asset.add_numbers<Joint>(
      "VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const std::size_t weights = asset.add_numbers<float>(
      "VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0, 0.5F, 0.5F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  asset.add_object({{"attributes",
                     {{"POSITION", positions},
                      {"NORMAL", normals},
                      {"JOINTS_0", joints},
                      {"WEIGHTS_0", weights}}},
                    {"mode", 5}});
  asset.json["nodes"][0]["skin"] = 0;
  asset.add("nodes", {{"name", "shoulder"}, {"children", {2}}});
  asset.add("nodes", {{"name", "elbow"}, {"translation", {1, 0, 0}}});
  asset.json["scenes"][0]["nodes"].push_back(1);
  const std::size_t inverse =
      asset.add_numbers<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
  asset.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", inverse}});
  return asset;
}

const std::vector<Vec3> straight = {Vec3(0, -1, 0), Vec3(0, 1, 0),  Vec3(1, -1, 0),
                                    Vec3(1, 1, 0),  Vec3(2, -1, 0), Vec3(2, 1, 0)};

TEST(GltfSkin, BindPoseEqualsTheMesh) {
  const LoadedScene loaded = load(arm());
  EXPECT_EQ(posed_mesh(loaded).positions, straight);
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
}

TEST(GltfSkin, ElbowBendsByNinetyDegrees) {
  AssetBuilder asset = arm();
  asset.json["nodes"][2]["rotation"] = {0, 0, half, half};
  const Mesh mesh = posed_mesh(load(asset));
  // The positions at the elbow are the means of (1, y) and (1 - y, 0).
  expect_near(mesh.positions, {Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(1.5F, -0.5F, 0),
                               Vec3(0.5F, 0.5F, 0), Vec3(2, 1, 0), Vec3(0, 1, 0)});
  expect_near(mesh.normals, {Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1),
                             Vec3(0, 1, 0), Vec3(0, 1, 0)});
}

TEST(GltfSkin, AnimatedJointsMoveTheMesh) {
  AssetBuilder asset = arm();
  const auto h = static_cast<float>(half);
  asset.animate(0, 1, "rotation", asset.add_numbers<float>("SCALAR", {0, 1}),
                asset.add_numbers<float>("VEC4", {0, 0, 0, 1, 0, 0, h, h}));
  expect_near(posed_mesh(load(asset, {.time = 1})).positions,
              {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0), Vec3(1, 2, 0),
               Vec3(-1, 2, 0)});
}

TEST(GltfSkin, TheNodesTransformIsIgnored) {
  AssetBuilder asset = arm();
  asset.json["nodes"][0].update({{"translation", {5, 6, 7}}, {"scale", {2, 2, 2}}});
  const LoadedScene loaded = load(asset);
  EXPECT_EQ(posed_mesh(loaded).positions, straight);
  EXPECT_EQ(posed_mesh(loaded).triangles, posed_mesh(load(arm())).triangles);
}

// The node's ignored transform must not translate the scene away from the mesh.
TEST(GltfSkin, JointsDecideWhetherTheSceneIsFarAway) {
  const auto open = [](const AssetBuilder& asset) {
    const std::string bytes = asset.embedded();
    return io::GltfFile(bytes, "test.gltf", "nowhere").at(std::nullopt).scene;
  };
  AssetBuilder asset = arm();
  asset.json["nodes"][0]["translation"] = {1e8, 0, 0};
  Scene scene = open(asset);
  EXPECT_EQ(scene.origin, DVec3(0));
  EXPECT_EQ(std::get<Mesh>(scene.objects.at(0).shape).positions, straight);

  asset = arm();
  asset.json["nodes"][1]["translation"] = {1e8, 0, 0};
  scene = open(asset);
  EXPECT_GT(scene.origin.x, 0.9e8);
  const Mesh& mesh = std::get<Mesh>(scene.objects.at(0).shape);
  for (std::size_t i = 0; i < straight.size(); ++i)
    EXPECT_EQ(DVec3(mesh.positions[i]) + scene.origin, DVec3(straight[i]) + DVec3(1e8, 0, 0));
}

TEST(GltfSkin, InverseBindMatricesDefaultToIdentity) {
  AssetBuilder asset = arm();
  asset.json["skins"][0].erase("inverseBindMatrices");
  expect_near(posed_mesh(load(asset)).positions, {Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(1.5F, -1, 0),
                                                  Vec3(1.5F, 1, 0), Vec3(3, -1, 0), Vec3(3, 1, 0)});
}

TEST(GltfSkin, JointsMayBeOutsideTheScene) {
  AssetBuilder asset = arm();
  asset.json["scenes"][0]["nodes"] = {0};
  asset.json["nodes"][1]["translation"] = {0, 0, 4};
  for (const Vec3& p : posed_mesh(load(asset)).positions) EXPECT_EQ(p.z, 4);
}

// glTF 2.0, section 3.7.4. Exporters put the mirrored scale of a rig into the node, the joints and
// their inverse bind matrices.
TEST(GltfSkin, TheDeterminantOfTheNodeDefinesTheWinding) {
  const Mesh usual = posed_mesh(load(arm()));
  Array<std::array<std::uint32_t, 3>> turned = usual.triangles;
  for (auto& corners : turned.edit()) std::swap(corners[1], corners[2]);
  AssetBuilder mirrored_joint = arm(), mirrored_node = arm();
  mirrored_joint.json["nodes"][1]["scale"] = {1, -1, 1};
  mirrored_node.json["nodes"][0]["scale"] = {-1, 1, 1};
  const Mesh by_joint = posed_mesh(load(mirrored_joint));
  EXPECT_EQ(by_joint.triangles, usual.triangles);
  EXPECT_EQ(by_joint.normals[0], Vec3(0, 0, 1));
  const Mesh by_node = posed_mesh(load(mirrored_node));
  EXPECT_EQ(by_node.triangles, turned);
  EXPECT_EQ(by_node.positions, usual.positions);
  EXPECT_EQ(by_node.normals, usual.normals);
}

// The bitangent is the cross product of normal and tangent, times w.
TEST(GltfSkin, MirrorsTurnTheHandednessOfTangents) {
  const auto handedness = [](double node, double joint) {
    AssetBuilder asset = arm();
    std::vector<float> tangents;
    for (int i = 0; i < 6; ++i) tangents.insert(tangents.end(), {0, 1, 0, 1});
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        asset.add_numbers<float>("VEC4", tangents);
    asset.json["nodes"][0]["scale"] = {node, 1, 1};
    asset.json["nodes"][1]["scale"] = {1, joint, 1};
    return posed_mesh(load(asset)).tangents[0];
  };
  EXPECT_EQ(handedness(1, 1), Vec4(0, 1, 0, 1));
  EXPECT_EQ(handedness(1, -1), Vec4(0, -1, 0, -1));
  EXPECT_EQ(handedness(-1, 1), Vec4(0, 1, 0, -1));
  EXPECT_EQ(handedness(-1, -1), Vec4(0, -1, 0, -1));
}

TEST(GltfSkin, EmptyInverseBindMatricesAreIdentities) {
  AssetBuilder asset = arm(), without = arm();
  without.json["skins"][0].erase("inverseBindMatrices");
  const std::size_t matrices = asset.json["skins"][0]["inverseBindMatrices"].to_size();
  asset.json["accessors"][matrices]["count"] = 0;
  const LoadedScene loaded = load(asset);
  EXPECT_EQ(posed_mesh(loaded).positions, posed_mesh(load(without)).positions);
  EXPECT_THAT(texts(loaded.warnings), testing::Contains(HasSubstr("identity matrices are used")));
}

TEST(GltfSkin, ReadsJointsAndWeightsOfAllTypesAndSets) {
  EXPECT_EQ(posed_mesh(load(arm<std::uint16_t>())).positions, straight);
  AssetBuilder asset = arm();
  asset.json["nodes"][2]["translation"] = {1, 0, 8};
  Json& attributes = asset.json["meshes"][0]["primitives"][0]["attributes"];
  const std::vector<std::uint8_t> bytes = {255, 0,   0, 0, 255, 0, 0, 0, 51,  204, 0, 0,
                                           51,  204, 0, 0, 255, 0, 0, 0, 255, 0,   0, 0};
  attributes["WEIGHTS_0"] = asset.add_numbers<std::uint8_t>("VEC4", bytes, true);
  EXPECT_FLOAT_EQ(posed_mesh(load(asset)).positions[2].z, 6.4F);
  std::vector<std::uint16_t> shorts;
  for (const std::uint8_t byte : bytes) shorts.push_back(static_cast<std::uint16_t>(257 * byte));
  attributes["WEIGHTS_0"] = asset.add_numbers<std::uint16_t>("VEC4", shorts, true);
  EXPECT_FLOAT_EQ(posed_mesh(load(asset)).positions[2].z, 6.4F);
  // The first set of influences gives the shoulder a weight of 1/4. The second set gives the elbow
  // a weight of 3/4.
  std::vector<float> quarter, rest;
  for (int i = 0; i < 6; ++i) {
    quarter.insert(quarter.end(), {0.25F, 0, 0, 0});
    rest.insert(rest.end(), {0, 0, 0.75F, 0});
  }
  attributes["JOINTS_0"] = asset.add_numbers<std::uint8_t>("VEC4", std::vector<std::uint8_t>(24));
  attributes["WEIGHTS_0"] = asset.add_numbers<float>("VEC4", quarter);
  attributes["JOINTS_1"] =
      asset.add_numbers<std::uint8_t>("VEC4", std::vector<std::uint8_t>(24, 1));
  attributes["WEIGHTS_1"] = asset.add_numbers<float>("VEC4", rest);
  const LoadedScene loaded = load(asset);
  for (const Vec3& p : posed_mesh(loaded).positions) EXPECT_EQ(p.z, 6);
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
}

TEST(GltfSkin, MorphingPrecedesSkinning) {
  AssetBuilder asset = arm();
  std::vector<Vec3> up(6, Vec3(0, 1, 0));
  asset.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", asset.add_positions(up)}}};
  asset.json["meshes"][0]["weights"] = {1};
  asset.json["nodes"][1]["rotation"] = {0, 0, half, half};
  expect_near(posed_mesh(load(asset)).positions, {Vec3(0, 0, 0), Vec3(-2, 0, 0), Vec3(0, 1, 0),
                                                  Vec3(-2, 1, 0), Vec3(0, 2, 0), Vec3(-2, 2, 0)});
}

TEST(GltfSkin, WeightsAreNormalizedWithAWarning) {
  AssetBuilder asset = arm();
  std::vector<float> weights = {3,    0,    0, 0, 1, 0, 0, 0, 0, 0, 0, 0,
                                0.5F, 0.5F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  asset.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
      asset.add_numbers<float>("VEC4", weights);
  const LoadedScene loaded = load(asset);
  EXPECT_EQ(posed_mesh(loaded).positions, straight);
  EXPECT_THAT(
      texts(loaded.warnings),
      testing::UnorderedElementsAre(
          AllOf(HasSubstr("/meshes/0/primitives/0/attributes/WEIGHTS_0"), HasSubstr("add up")),
          HasSubstr("first joint")));
}

TEST(GltfSkin, JointIndexOutOfRangeIsRefused) {
  AssetBuilder asset = arm();
  asset.json["skins"][0]["joints"] = {1};
  try {
    (void)load(asset);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
    EXPECT_EQ(error.diagnostic().pointer, "/meshes/0/primitives/0/attributes/JOINTS_0");
    EXPECT_THAT(error.what(), HasSubstr("joint 1"));
  }
}

// Exporters have filled unused influences with the number of joints.
TEST(GltfSkin, UnusedInfluencesMayNameAnyJoint) {
  AssetBuilder asset = arm();
  const std::size_t vertices = straight.size();
  std::vector<float> weights;
  std::vector<std::uint8_t> joints;
  for (std::size_t i = 0; i < vertices; ++i) {
    weights.insert(weights.end(), {1, 0, 0, 0});
    joints.insert(joints.end(), {0, 255, 2, 2});
  }
  Json& attributes = asset.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["WEIGHTS_0"] = asset.add_numbers<float>("VEC4", weights);
  attributes["JOINTS_0"] = asset.add_numbers<std::uint8_t>("VEC4", joints);
  const LoadedScene loaded = load(asset);
  EXPECT_EQ(posed_mesh(loaded).positions, straight);
  EXPECT_THAT(texts(loaded.warnings), testing::ElementsAre(HasSubstr("with a weight of 0")));
}

TEST(GltfSkin, MeshWithoutJointsIsPlacedByItsNode) {
  AssetBuilder asset = arm();
  Json& attributes = asset.json["meshes"][0]["primitives"][0]["attributes"];
  attributes.erase("JOINTS_0");
  attributes.erase("WEIGHTS_0");
  asset.json["nodes"][0]["translation"] = {0, 0, 3};
  const LoadedScene loaded = load(asset);
  EXPECT_EQ(posed_mesh(loaded).positions[0], Vec3(0, -1, 3));
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("JOINTS_0")));
}

}  // namespace
}  // namespace microtrace::tests
