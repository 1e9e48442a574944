#include "gltf/asset_builder.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Mesh first_mesh(const LoadedScene& loaded) {
  return std::get<Mesh>(loaded.scene.objects.at(0).shape);
}

/// Returns the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) with all attributes and two morph targets.
AssetBuilder morphed_triangle() {
  AssetBuilder asset;
  const Json attributes = {
      {"POSITION", asset.add_positions({Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)})},
      {"NORMAL", asset.add_numbers<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})},
      {"TANGENT", asset.add_numbers<float>("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1})},
      {"TEXCOORD_0", asset.add_numbers<float>("VEC2", {0, 0, 1, 0, 0, 1})},
      {"COLOR_0", asset.add_numbers<float>("VEC3", {0, 0, 0, 1, 1, 1, 0.5F, 0.5F, 0.5F})}};
  const Json first = {{"POSITION", asset.add_positions({Vec3(0, 0, 4), Vec3(0), Vec3(0, 8, 0)})},
                      {"NORMAL", asset.add_numbers<float>("VEC3", {2, 0, 0, 0, 0, 0, 0, 0, -4})},
                      {"TANGENT", asset.add_numbers<float>("VEC3", {-2, 0, 2, 0, 0, 0, -4, 0, 0})}};
  const Json second = {
      {"POSITION", asset.add_positions({Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0)})},
      {"TEXCOORD_0", asset.add_numbers<float>("VEC2", {2, 4, 0, 0, 0, 0})},
      {"COLOR_0", asset.add_numbers<float>("VEC3", {1, 0.25F, 0, 1, -4, 0, 0, 0, 0})}};
  asset.add_object({{"attributes", attributes}, {"targets", {first, second}}});
  return asset;
}

TEST(GltfMorph, WithoutWeightsNothingIsMorphed) {
  const LoadedScene loaded = load(morphed_triangle());
  EXPECT_THAT(first_mesh(loaded).positions, ElementsAre(Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)));
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
}

TEST(GltfMorph, TargetsAreWeightedByTheMesh) {
  AssetBuilder asset = morphed_triangle();
  asset.json["meshes"][0]["weights"] = {0.5, -2};
  EXPECT_THAT(first_mesh(load(asset)).positions,
              ElementsAre(Vec3(-2, 0, 2), Vec3(-1, 0, 0), Vec3(-2, 5, 0)));
}

TEST(GltfMorph, NodeWeightsReplaceMeshWeights) {
  AssetBuilder asset = morphed_triangle();
  asset.json["meshes"][0]["weights"] = {0.5, -2};
  asset.json["nodes"][0].update({{"weights", {1, 0}}, {"scale", {2, 2, 2}}});
  EXPECT_THAT(first_mesh(load(asset)).positions,
              ElementsAre(Vec3(0, 0, 8), Vec3(2, 0, 0), Vec3(0, 18, 0)));
}

// glTF requires the same number of targets of all primitives.
TEST(GltfMorph, PrimitivesMayHaveFewerTargetsThanLaterOnes) {
  AssetBuilder asset = morphed_triangle();
  asset.json["meshes"][0]["weights"] = {0.5, -2};
  auto& primitives = asset.json["meshes"][0]["primitives"];
  const Json plain = {{"attributes", {{"POSITION", primitives[0]["attributes"]["POSITION"]}}}};
  const Json morphed = primitives[0];
  primitives = {plain, morphed};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(first_mesh(loaded).positions, ElementsAre(Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)));
  EXPECT_THAT(std::get<Mesh>(loaded.scene.objects.at(1).shape).positions,
              ElementsAre(Vec3(-2, 0, 2), Vec3(-1, 0, 0), Vec3(-2, 5, 0)));
}

TEST(GltfMorph, AnimationsSetWeights) {
  AssetBuilder asset = morphed_triangle();
  asset.json["meshes"][0]["weights"] = {7, 7};
  asset.animate(0, 0, "weights", asset.add_numbers<float>("SCALAR", {0, 1}),
                asset.add_numbers<float>("SCALAR", {0, 1, 1, 0}));
  EXPECT_THAT(first_mesh(load(asset, {.time = 0.25})).positions,
              ElementsAre(Vec3(0.75F, 0, 1), Vec3(1.75F, 0, 0), Vec3(0.75F, 3, 0)));
  // In a cubic spline, each key has in-tangents, values and out-tangents, each with a number for
  // every weight.
  asset.json.erase("animations");
  asset.animate(0, 0, "weights", asset.add_numbers<float>("SCALAR", {0, 1}),
                asset.add_numbers<float>("SCALAR", {9, 9, 0, 1, 0, 0, 0, 0, 1, 0, 9, 9}),
                "CUBICSPLINE");
  EXPECT_THAT(first_mesh(load(asset, {.time = 0.5})).positions,
              ElementsAre(Vec3(0.5F, 0, 2), Vec3(1.5F, 0, 0), Vec3(0.5F, 5, 0)));
  // Weights may be normalized bytes.
  asset.json.erase("animations");
  asset.animate(0, 0, "weights", asset.add_numbers<float>("SCALAR", {0, 1}),
                asset.add_numbers<std::uint8_t>("SCALAR", {255, 0, 0, 255}, true));
  EXPECT_THAT(first_mesh(load(asset, {.time = 0})).positions,
              ElementsAre(Vec3(0, 0, 4), Vec3(1, 0, 0), Vec3(0, 9, 0)));
}

TEST(GltfMorph, TargetsMorphOtherAttributes) {
  AssetBuilder asset = morphed_triangle();
  asset.json["meshes"][0]["weights"] = {0.5, 0.5};
  const LoadedScene loaded = load(asset);
  const Mesh mesh = first_mesh(loaded);
  const float half = std::sqrt(0.5F);
  EXPECT_THAT(mesh.normals, ElementsAre(Vec3(half, 0, half), Vec3(0, 0, 1), Vec3(0, 0, -1)));
  EXPECT_THAT(mesh.tangents, ElementsAre(Vec4(0, 0, 1, 1), Vec4(1, 0, 0, 1), Vec4(-1, 0, 0, -1)));
  EXPECT_THAT(mesh.uv_sets.at(0), ElementsAre(Vec2(1, 2), Vec2(1, 0), Vec2(0, 1)));
  // Colors must be clamped to [0, 1].
  EXPECT_THAT(mesh.colors,
              ElementsAre(Vec4(0.5F, 0.125F, 0, 1), Vec4(1, 0, 1, 1), Vec4(0.5F, 0.5F, 0.5F, 1)));
}

TEST(GltfMorph, TargetsMayBeSparseWithoutABase) {
  AssetBuilder asset = morphed_triangle();
  const std::size_t indices = asset.add_view(bytes_of<std::uint16_t>({1}));
  const std::size_t values = asset.add_view(bytes_of<float>({0, 0, 3}));
  asset.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] =
      asset.add("accessors", {{"componentType", kFloat32},
                              {"count", 3},
                              {"type", "VEC3"},
                              {"min", {0, 0, 0}},
                              {"max", {0, 0, 3}},
                              {"sparse",
                               {{"count", 1},
                                {"indices", {{"bufferView", indices}, {"componentType", kUint16}}},
                                {"values", {{"bufferView", values}}}}}});
  asset.json["meshes"][0]["weights"] = {2, 0};
  EXPECT_THAT(first_mesh(load(asset)).positions,
              ElementsAre(Vec3(0), Vec3(1, 0, 6), Vec3(0, 1, 0)));
}

TEST(GltfMorph, TargetsMayBeQuantized) {
  AssetBuilder asset = morphed_triangle();
  asset.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  asset.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const std::size_t view =
      asset.add_view(bytes_of<std::int8_t>({127, 0, 0, 0, 0, -127, 0, 0, 0, -128, 0, 0}), 4);
  asset.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] =
      asset.add("accessors", {{"bufferView", view},
                              {"componentType", kInt8},
                              {"normalized", true},
                              {"count", 3},
                              {"type", "VEC3"},
                              {"min", {0, -128, 0}},
                              {"max", {127, 0, 0}}});
  asset.json["meshes"][0]["weights"] = {3, 0};
  EXPECT_THAT(first_mesh(load(asset)).positions,
              ElementsAre(Vec3(3, 0, 0), Vec3(1, -3, 0), Vec3(0, -2, 0)));
}

TEST(GltfMorph, EachVertexIsRoundedOnce) {
  AssetBuilder asset = morphed_triangle();
  // float32 cannot represent 2^24 + 1. The node's transform brings the sum back to 1, so an
  // intermediate rounding would show.
  asset.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] =
      asset.add_positions({Vec3(0x1p24F, 0, 0), Vec3(0x1p24F, 0, 0), Vec3(0x1p24F, 0, 0)});
  asset.json["meshes"][0]["weights"] = {1, 0};
  asset.json["nodes"][0]["translation"] = {-0x1p24, 0, 0};
  EXPECT_THAT(first_mesh(load(asset)).positions,
              ElementsAre(Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)));
}

TEST(GltfMorph, DisplacementsAreLimited) {
  AssetBuilder asset = morphed_triangle();
  // A small file that would cause excessive work: 32 nodes share a mesh with 2048 morph targets,
  // which all use one large accessor.
  constexpr std::size_t kVertices = 3 * 4096, kTargets = 2048, kNodes = 32;
  Json position = {{"componentType", kFloat32},
                   {"count", kVertices},
                   {"type", "VEC3"},
                   {"min", {0, 0, 0}},
                   {"max", {0, 0, 0}}};
  Json& mesh = asset.json["meshes"][0];
  mesh["primitives"][0]["attributes"] = {{"POSITION", asset.add("accessors", position)}};
  mesh["primitives"][0]["targets"] =
      Json::repeated(kTargets, {{"POSITION", asset.json["accessors"].size() - 1}});
  mesh["weights"] = Json::repeated(kTargets, 1);
  asset.json["nodes"] = Json::repeated(kNodes, {{"mesh", 0}});
  asset.json.erase("scenes");
  asset.json.erase("scene");
  try {
    (void)load(asset);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
    EXPECT_THAT(error.what(), HasSubstr("displacements"));
  }
}

}  // namespace
}  // namespace microtrace::tests
