#include "gltf/asset_builder.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Two adjacent squares that face +z and share vertices 1 and 4. In the left one u points right and
/// v points down. In the right one u is reversed. The material has a normal texture.
AssetBuilder folded() {
  AssetBuilder asset;
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0},
                                     {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  const std::size_t positions = asset.add_positions(corners);
  const std::size_t indices = asset.add_indices({0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}, kUint16);
  std::vector<float> normals;
  for (std::size_t i = 0; i < 6; ++i) normals.insert(normals.end(), {0, 0, 1});
  asset.add_object(
      {{"attributes",
        {{"POSITION", positions},
         {"NORMAL", asset.add_numbers("VEC3", normals)},
         {"TEXCOORD_0",
          asset.add_numbers("VEC2", std::vector<float>{0, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 0})}}},
       {"indices", indices},
       {"material", 0}});
  asset.add("materials", {{"normalTexture", {{"index", 0}}}});
  asset.add("textures", {{"source", 0}});
  asset.add("images", {{"uri", "data:image/avif;base64," + base64("ftypavif")}});
  return asset;
}

Mesh mesh_of(const AssetBuilder& asset, const LoadOptions& options = {}) {
  return std::get<Mesh>(load(asset, options).scene.objects.at(0).shape);
}

Json& attributes(AssetBuilder& asset) {
  return asset.json["meshes"][0]["primitives"][0]["attributes"];
}

TEST(GltfTangent, IsGeneratedIfTheMaterialNeedsIt) {
  AssetBuilder asset = folded();
  const Mesh mesh = mesh_of(asset);
  ASSERT_EQ(mesh.tangents.size(), 8U);
  for (std::size_t t = 0; t < 4; ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      EXPECT_EQ(mesh.tangents[vertex], t < 2 ? Vec4(1, 0, 0, 1) : Vec4(-1, 0, 0, -1));
    }
  }
  EXPECT_THAT(mesh_of(asset, {.detail = SurfaceDetail::color}).tangents, IsEmpty());
  asset.json["materials"][0] = Json::object();
  EXPECT_THAT(mesh_of(asset).tangents, IsEmpty());
  EXPECT_EQ(mesh_of(asset).positions.size(), 6U);
}

TEST(GltfTangent, IsGeneratedForClearcoatAndAnisotropy) {
  AssetBuilder asset = folded();
  asset.json["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_materials_anisotropy"};
  asset.json["materials"][0] = Json::parse(R"({"extensions": {
    "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0}}}})");
  EXPECT_EQ(mesh_of(asset).tangents.size(), 8U);
  asset.json["materials"][0] = Json::parse(R"({"extensions": {
    "KHR_materials_anisotropy": {"anisotropyStrength": 1}}})");
  EXPECT_EQ(mesh_of(asset).tangents.size(), 8U);
}

TEST(GltfTangent, FollowsTheTextureCoordinatesOfTheNormalTexture) {
  AssetBuilder asset = folded();
  asset.json["materials"][0]["normalTexture"]["texCoord"] = 1;
  EXPECT_THAT(mesh_of(asset).tangents, IsEmpty()) << "there is no such set";
  attributes(asset)["TEXCOORD_1"] = asset.add_numbers(
      "VEC2", std::vector<float>{0, 0, 0, 1, 0, 2, 1, 0, 1, 1, 1, 2});  // u up, v to the right
  for (const Vec4& t : mesh_of(asset).tangents) EXPECT_EQ(t, Vec4(0, 1, 0, 1));
  asset.json["extensionsUsed"] = {"KHR_texture_transform"};
  asset.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = {
      {"texCoord", 0}, {"rotation", 1.5}};
  EXPECT_EQ(mesh_of(asset).tangents.size(), 8U);
}

TEST(GltfTangent, IsIgnoredWithoutNormals) {
  AssetBuilder asset = folded();
  std::vector<float> own;
  for (std::size_t i = 0; i < 6; ++i) own.insert(own.end(), {0, 1, 0, -1});
  attributes(asset)["TANGENT"] = asset.add_numbers("VEC4", own);
  const Mesh with_normals = mesh_of(asset);
  EXPECT_EQ(with_normals.positions.size(), 6U);
  for (const Vec4& t : with_normals.tangents) EXPECT_EQ(t, Vec4(0, 1, 0, -1));
  attributes(asset).erase("NORMAL");
  const Mesh flat = mesh_of(asset);
  EXPECT_THAT(flat.normals, IsEmpty());
  ASSERT_EQ(flat.tangents.size(), 8U);
  EXPECT_EQ(flat.tangents[flat.triangles[0][0]], Vec4(1, 0, 0, 1));
}

TEST(GltfTangent, SplitVerticesKeepTheirMorphTargets) {
  AssetBuilder asset = folded();
  std::vector<Vec3> deltas(6, Vec3(0));
  deltas[1] = {0, -1, 0}, deltas[4] = {0, 1, 0};
  asset.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", asset.add_positions(deltas)}}};
  asset.json["meshes"][0]["weights"] = {1};
  EXPECT_THAT(mesh_of(asset).positions,
              ElementsAre(Vec3(0, 0, 0), Vec3(1, -1, 0), Vec3(1, -1, 0), Vec3(2, 0, 0),
                          Vec3(0, 1, 0), Vec3(1, 2, 0), Vec3(1, 2, 0), Vec3(2, 1, 0)));
}

TEST(GltfTangent, IsTransformedByItsNode) {
  AssetBuilder asset = folded();
  asset.json["nodes"][0]["scale"] = {-2, 1, 1};
  const Mesh mesh = mesh_of(asset);
  ASSERT_EQ(mesh.tangents.size(), 8U);
  for (std::size_t t = 0; t < 4; ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      EXPECT_EQ(mesh.tangents[vertex], t < 2 ? Vec4(-1, 0, 0, -1) : Vec4(1, 0, 0, 1));
    }
  }
}

}  // namespace
}  // namespace microtrace::tests
