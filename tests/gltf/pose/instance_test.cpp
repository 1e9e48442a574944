#include "gltf/asset_builder.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

/// Returns the triangle (0,0,0) (1,0,0) (0,1,0) on a node at x = 100.
AssetBuilder instanced_triangle() {
  AssetBuilder asset;
  asset.json["extensionsUsed"] = {kInstancing};
  asset.add_object(
      {{"attributes", {{"POSITION", asset.add_positions({Vec3(0), {1, 0, 0}, {0, 1, 0}})}}}});
  asset.json["nodes"][0]["translation"] = {100, 0, 0};
  asset.json["nodes"][0]["name"] = "Tree";
  return asset;
}

template <typename Number>
std::size_t add_attribute(AssetBuilder& asset, int type, const char* shape, bool normalized,
                          const std::vector<Number>& numbers, std::size_t count) {
  return asset.add("accessors", {{"bufferView", asset.add_view(bytes_of<Number>(numbers))},
                                 {"componentType", type},
                                 {"normalized", normalized},
                                 {"count", count},
                                 {"type", shape}});
}

void instantiate(AssetBuilder& asset, Json attributes) {
  asset.json["nodes"][0]["extensions"][kInstancing]["attributes"] = std::move(attributes);
}

TEST(GltfInstances, AreTransformedWithinTheirNode) {
  AssetBuilder asset = instanced_triangle();
  const std::size_t moves =
      add_attribute<float>(asset, kFloat32, "VEC3", false, {0, 0, 0, 0, 10, 0}, 2);
  const std::size_t turns =
      add_attribute<std::int16_t>(asset, 5122, "VEC4", true, {0, 0, 0, 32767, 0, 0, 32767, 0}, 2);
  const std::size_t sizes =
      add_attribute<float>(asset, kFloat32, "VEC3", false, {1, 1, 1, 2, 3, 4}, 2);
  instantiate(asset, {{"TRANSLATION", moves}, {"ROTATION", turns}, {"SCALE", sizes}});
  const LoadedScene scene = load(asset);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.scene.objects, SizeIs(2));
  EXPECT_EQ(scene.scene.objects[0].name, "Tree[0]/mesh0");
  EXPECT_EQ(scene.scene.objects[1].name, "Tree[1]/mesh0");
  EXPECT_THAT(triangles_of(scene.scene.objects[0]),
              ElementsAre(std::array{Vec3(100, 0, 0), Vec3(101, 0, 0), Vec3(100, 1, 0)}));
  // The second instance is scaled and then rotated by 180 degrees about z.
  EXPECT_THAT(triangles_of(scene.scene.objects[1]),
              ElementsAre(std::array{Vec3(100, 10, 0), Vec3(98, 10, 0), Vec3(100, 7, 0)}));
}

TEST(GltfInstances, AreStoredAsOneRunIfTheyShareAMesh) {
  AssetBuilder asset = instanced_triangle();
  instantiate(asset, {{"TRANSLATION", add_attribute<float>(asset, kFloat32, "VEC3", false,
                                                           {0, 0, 0, 0, 10, 0, 0, 20, 0}, 3)}});
  const LoadedScene copied = load(asset, {.instancing = Instancing::copied});
  const LoadedScene shared = load(asset, {.instancing = Instancing::shared});
  const Objects& objects = shared.scene.objects;
  EXPECT_EQ(objects.runs().size(), 1U);
  ASSERT_THAT(objects, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(objects.name(i), copied.scene.objects[i].name);
    EXPECT_EQ(objects[i].name, copied.scene.objects[i].name);
    const auto& mesh = std::get<Mesh>(objects[i].shape);
    const auto& copy = std::get<Mesh>(copied.scene.objects[i].shape);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(mesh.position(k), copy.positions[k]);
  }
}

TEST(GltfInstances, CustomAttributesMayDefineTheirNumber) {
  AssetBuilder asset = instanced_triangle();
  instantiate(asset,
              {{"_ID", add_attribute<float>(asset, kFloat32, "SCALAR", false, {7, 8, 9}, 3)}});
  EXPECT_THAT(load(asset).scene.objects, SizeIs(3));
}

TEST(GltfInstances, ZeroQuaternionsAreIgnored) {
  AssetBuilder asset = instanced_triangle();
  instantiate(
      asset, {{"ROTATION", add_attribute<float>(asset, kFloat32, "VEC4", false, {0, 0, 0, 0}, 1)}});
  const LoadedScene scene = load(asset);
  EXPECT_THAT(texts(scene.warnings), ElementsAre(HasSubstr("zero quaternions")));
  EXPECT_EQ(triangles_of(scene.scene.objects.at(0))[0][1], Vec3(101, 0, 0));
}

TEST(GltfInstances, OtherQuaternionsAreNormalized) {
  AssetBuilder asset = instanced_triangle();
  instantiate(asset, {{"ROTATION", add_attribute<float>(asset, kFloat32, "VEC4", false,
                                                        {0, 0, 0, 2, 0, 0, 3, 0}, 2)}});
  const LoadedScene scene = load(asset);
  EXPECT_THAT(texts(scene.warnings), ElementsAre(HasSubstr("not of unit length")));
  EXPECT_EQ(triangles_of(scene.scene.objects.at(0))[0][1], Vec3(101, 0, 0));
}

TEST(GltfInstances, InvalidAttributesAreRefused) {
  struct Case {
    const char* name;
    int type;
    const char* shape;
    std::size_t count;
    const char* pointer;
  };
  const std::vector<Case> cases = {
      {"TRANSLATION", kUint16, "VEC3", 2, "/attributes/TRANSLATION"},
      {"ROTATION", kFloat32, "VEC3", 2, "/attributes/ROTATION"},
      {"SCALE", kFloat32, "VEC3", 3, "/attributes/_OTHER"},
  };
  for (const Case& c : cases) {
    AssetBuilder asset = instanced_triangle();
    const std::vector<float> zeros(16);
    instantiate(asset,
                {{c.name, add_attribute<float>(asset, c.type, c.shape, false, zeros, c.count)},
                 {"_OTHER", add_attribute<float>(asset, kFloat32, "SCALAR", false, zeros, 2)}});
    try {
      (void)load(asset);
      ADD_FAILURE() << c.name << " accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
      EXPECT_THAT(error.diagnostic().pointer, HasSubstr(c.pointer));
    }
  }
}

TEST(GltfInstances, TooManyAreRefusedBeforeAllocation) {
  AssetBuilder asset = instanced_triangle();
  instantiate(asset, {{"SCALE", asset.add("accessors", {{"componentType", kFloat32},
                                                        {"count", (1U << 22) + 1},
                                                        {"type", "VEC3"}})}});
  try {
    (void)load(asset);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
  }
}

TEST(GltfVisibility, HidesANodeAndItsDescendantsButNoCamera) {
  AssetBuilder asset = instanced_triangle();
  asset.json["extensionsUsed"] = {"KHR_node_visibility"};
  asset.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  const std::size_t child = asset.add(
      "nodes",
      {{"mesh", 0}, {"camera", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
  asset.json["nodes"][0]["children"] = {child};
  asset.json["nodes"][0]["extensions"]["KHR_node_visibility"] = Json::object();
  EXPECT_THAT(load(asset).scene.objects, SizeIs(2));
  asset.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  const LoadedScene scene = load(asset);
  EXPECT_THAT(scene.scene.objects, IsEmpty());
  EXPECT_EQ(scene.scene.cameras.at(0).name, "node1");
}

TEST(GltfInstances, EmptyAccessorsMakeNone) {
  for (const char* empty : {"TRANSLATION", "SCALE", "_ID"}) {
    AssetBuilder asset = instanced_triangle();
    Json attributes = {{"TRANSLATION", asset.add_numbers<float>("VEC3", {0, 0, 0, 1, 1, 1})},
                       {"SCALE", asset.add_numbers<float>("VEC3", {1, 1, 1, 1, 1, 1})}};
    attributes[empty] =
        asset.add("accessors", {{"componentType", kFloat32}, {"count", 0}, {"type", "VEC3"}});
    instantiate(asset, attributes);
    const LoadedScene loaded = load(asset);
    EXPECT_THAT(loaded.scene.objects, testing::IsEmpty()) << empty;
    EXPECT_THAT(texts(loaded.warnings),
                testing::Contains(testing::HasSubstr("there are no instances")));
  }
}

}  // namespace
}  // namespace microtrace::tests
