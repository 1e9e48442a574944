#include "gltf/asset_builder.hpp"

#include <cmath>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A triangle to which tests add vertex attributes.
struct AttributeAsset : AssetBuilder {
  AttributeAsset() {
    add_object({{"attributes", {{"POSITION", add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}}});
  }

  template <typename Number>
  void add_attribute(const char* name, const char* type, int component_type,
                     const std::vector<Number>& numbers, bool normalized = false) {
    Json accessor = {{"bufferView", add_view(bytes_of(numbers))},
                     {"componentType", component_type},
                     {"count", 3},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    json["meshes"][0]["primitives"][0]["attributes"][name] = add("accessors", accessor);
  }

  [[nodiscard]] Mesh mesh() const { return std::get<Mesh>(load(*this).scene.objects.at(0).shape); }
};

TEST(GltfAttributes, AbsentAttributesUseNoMemory) {
  const Mesh mesh = AttributeAsset().mesh();
  EXPECT_THAT(mesh.normals, IsEmpty());
  EXPECT_THAT(mesh.tangents, IsEmpty());
  EXPECT_THAT(mesh.uv_sets, IsEmpty());
  EXPECT_THAT(mesh.colors, IsEmpty());
}

TEST(GltfAttributes, NormalsAndTangentsFollowAMirroredNode) {
  AttributeAsset asset;
  const float h = std::sqrt(0.5F);
  asset.add_attribute<float>("NORMAL", "VEC3", kFloat32, {h, h, 0, 0, 0, 1, 0, 0, 0});
  asset.add_attribute<float>("TANGENT", "VEC4", kFloat32, {h, -h, 0, 1, 1, 0, 0, -1, 0, 1, 0, 1});
  asset.json["nodes"][0]["scale"] = {-2, 1, 1};
  const Mesh mesh = asset.mesh();
  // The unmirrored normal is perpendicular to (1, -1), and the mirrored one is perpendicular to
  // (-2, -1).
  const float r = std::sqrt(0.2F);
  ASSERT_EQ(mesh.normals.size(), 3U);
  EXPECT_NEAR(mesh.normals[0].x, -r, 1e-6F);
  EXPECT_NEAR(mesh.normals[0].y, 2 * r, 1e-6F);
  EXPECT_EQ(mesh.normals[1], Vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals[2], Vec3(0));
  ASSERT_EQ(mesh.tangents.size(), 3U);
  EXPECT_NEAR(mesh.tangents[0].x, -2 * r, 1e-6F);
  EXPECT_NEAR(mesh.tangents[0].y, -r, 1e-6F);
  EXPECT_EQ(mesh.tangents[0].w, -1);
  EXPECT_EQ(mesh.tangents[1], Vec4(-1, 0, 0, 1));
}

TEST(GltfAttributes, NormalsOfAFlattenedNodeArePerpendicularToItsPlane) {
  AttributeAsset asset;
  asset.add_attribute<float>("NORMAL", "VEC3", kFloat32, {0, 0, 1, 0.6F, 0, 0.8F, 1, 0, 0});
  asset.json["nodes"][0]["scale"] = {3, 5, 0};
  EXPECT_THAT(asset.mesh().normals, ElementsAre(Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0)));
}

TEST(GltfAttributes, ColorsMayBeBytesWithoutAlpha) {
  AttributeAsset asset;
  asset.add_attribute<std::uint8_t>("COLOR_0", "VEC4", kUint8,
                                    {255, 0, 51, 102, 0, 0, 0, 0, 255, 255, 255, 255}, true);
  EXPECT_THAT(asset.mesh().colors, ElementsAre(Vec4(1, 0, 0.2F, 0.4F), Vec4(0), Vec4(1)));
  AttributeAsset opaque;
  opaque.add_attribute<float>("COLOR_0", "VEC3", kFloat32, {1, 0, 0, 0, 1, 0, 0, 0, 0.5F});
  EXPECT_THAT(opaque.mesh().colors,
              ElementsAre(Vec4(1, 0, 0, 1), Vec4(0, 1, 0, 1), Vec4(0, 0, 0.5F, 1)));
}

TEST(GltfAttributes, TextureCoordinatesKeepTheirSetNumber) {
  AttributeAsset asset;
  asset.add_attribute<float>("TEXCOORD_0", "VEC2", kFloat32, {0, 1, 2, 3, 4, 5});
  asset.add_attribute<std::uint16_t>("TEXCOORD_1", "VEC2", kUint16, {0, 65535, 13107, 0, 0, 0},
                                     true);
  const Mesh mesh = asset.mesh();
  ASSERT_EQ(mesh.uv_sets.size(), 2U);
  EXPECT_THAT(mesh.uv_sets[0], ElementsAre(Vec2(0, 1), Vec2(2, 3), Vec2(4, 5)));
  EXPECT_THAT(mesh.uv_sets[1], ElementsAre(Vec2(0, 1), Vec2(0.2F, 0), Vec2(0)));
}

TEST(GltfAttributes, OnlyVerticesOfTrianglesHaveAttributes) {
  AttributeAsset asset;
  asset.add_attribute<float>("TEXCOORD_0", "VEC2", kFloat32, {0, 1, 2, 3, 4, 5});
  asset.json["meshes"][0]["primitives"][0]["indices"] = asset.add_indices({2, 0, 2}, kUint16);
  const Mesh mesh = asset.mesh();
  EXPECT_EQ(mesh.positions.size(), 2U);
  EXPECT_THAT(mesh.uv_sets.at(0), ElementsAre(Vec2(0, 1), Vec2(4, 5)));
}

TEST(GltfAttributes, IgnoresAttributesOfAnotherType) {
  AttributeAsset asset;
  asset.add_attribute<float>("TEXCOORD_0", "VEC3", kFloat32, {0, 1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_THAT(texts(load(asset).warnings),
              testing::Contains(testing::HasSubstr(
                  "/meshes/0/primitives/0/attributes/TEXCOORD_0: refers to an accessor of VEC3")));
  EXPECT_THAT(asset.mesh().uv_sets, IsEmpty());
}

TEST(GltfAttributes, FlatPicturesReadOnlyVisibleAttributes) {
  AttributeAsset asset;
  asset.add_attribute<float>("NORMAL", "VEC3", kFloat32, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  asset.add_attribute<float>("TEXCOORD_0", "VEC2", kFloat32, {0, 1, 2, 3, 4, 5});
  asset.add_attribute<float>("COLOR_0", "VEC3", kFloat32, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  const LoadedScene loaded =
      parse_scene(asset.embedded(), "test.gltf", "", {.detail = SurfaceDetail::color});
  const Mesh& mesh = std::get<Mesh>(loaded.scene.objects.at(0).shape);
  EXPECT_THAT(mesh.normals, IsEmpty());
  EXPECT_THAT(mesh.uv_sets, IsEmpty());
  EXPECT_EQ(mesh.colors.size(), 3U);
}

}  // namespace
}  // namespace microtrace::tests
