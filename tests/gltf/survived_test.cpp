#include "gltf/asset_builder.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// What breaks the specification, and is drawn with a warning. `where` and `value` are those of
/// `mutated`.
struct Survived {
  const char* where;
  const char* value;
  const char* pointer;
  const char* message;
};

const Survived mutations[] = {
    // The asset as a whole.
    {"/asset/version", "\"2.1\"", "/asset/version", "read as glTF 2.0"},
    {"/asset/minVersion", "\"2.1\"", "/asset/minVersion", "greater than version"},
    {"/asset", R"({"version": "2.1", "minVersion": "2.1"})", "/asset/minVersion", "asks for more"},
    {"/extensionsRequired", R"(["X_a"])", "/extensionsRequired/0", "missing in extensionsUsed"},
    {"/extensionsUsed", "[]", "/extensionsUsed", "is empty"},
    {"/extensions", R"({"X_a": {}})", "/extensions/X_a", "not declared"},
    {"", R"({"extensionsUsed": ["KHR_materials_unlit"],
             "extensions": {"KHR_materials_unlit": {}}})",
     "/extensions/KHR_materials_unlit", "no place in this object"},
    {"", R"({"extensionsUsed": ["KHR_lights_punctual"],
             "nodes": [{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}]})",
     "/nodes/0/extensions/KHR_lights_punctual/light", "absent"},

    // Values that are none of the known ones.
    {"/bufferViews/0/target", "1", "/bufferViews/0/target", "must be one of"},
    {"/materials/0/alphaMode", "\"GLASS\"", "/materials/0/alphaMode", "must be one of"},
    {"/samplers", R"([{"wrapS": 1, "minFilter": 2}])", "/samplers/0/wrapS", "must be one of"},

    // Scenes.
    {"/scenes/0/nodes", "[]", "/scenes/0/nodes", "is empty"},
    {"/nodes/0/matrix", "[1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]", "/nodes/0/matrix",
     "is not affine"},
    {"/meshes/0/primitives", "[]", "/meshes/0/primitives", "is empty"},
};

TEST(GltfSurvived, EveryMutationOfTheCubeIsDrawnWithAWarningAtItsPlace) {
  for (const auto& [where, value, pointer, message] : mutations) {
    SCOPED_TRACE(std::string(where) + " = " + value);
    EXPECT_THAT(texts(load(mutated(cube(), where, value)).warnings),
                Contains(AllOf(HasSubstr(std::string(pointer) + ": "), HasSubstr(message))));
  }
}

TEST(GltfSurvived, ACameraOfUnknownTypeIsLeftOut) {
  AssetBuilder asset = cube();
  asset.json["cameras"] = {{{"type", "fisheye"}}};
  asset.json["nodes"][0]["camera"] = 0;
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), Contains(HasSubstr("/cameras/0/type: must be one of")));
  EXPECT_THAT(loaded.scene.cameras, IsEmpty());
}

TEST(GltfSurvived, PrimitiveRestartStartsANewPrimitive) {
  for (const auto& [type, restart] :
       {std::pair{u8, 0xFFU}, std::pair{u16, 0xFFFFU}, std::pair{u32, 0xFFFFFFFFU}}) {
    AssetBuilder asset;
    const std::size_t positions = asset.add_positions({Vec3(0), Vec3(1), Vec3(2), Vec3(3)});
    const std::size_t indices = asset.add_indices({0, 1, 2, restart, 1, 2, 3}, type);
    asset.add_object(
        {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", 5}});
    const LoadedScene loaded = load(asset);
    EXPECT_THAT(texts(loaded.warnings), Contains(HasSubstr("/accessors/1: has the value that")));
    const auto triangles = triangles_of(loaded.scene.objects.at(0));
    ASSERT_THAT(triangles, SizeIs(2));
    EXPECT_EQ(triangles[1][0], Vec3(1));
    EXPECT_EQ(triangles[1][2], Vec3(3));
  }
}

TEST(GltfSurvived, AChildThatASceneNamesStaysInItsPlace) {
  AssetBuilder asset = cube();
  asset.json["nodes"][0]["translation"] = {1, 0, 0};
  asset.json["nodes"].push_back({{"children", {0}}, {"translation", {10, 0, 0}}});
  asset.json["scenes"][0]["nodes"] = {0, 1};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), Contains(HasSubstr("/scenes/0/nodes/0: is a child")));
  ASSERT_THAT(loaded.scene.objects, SizeIs(1));
  EXPECT_EQ(triangles_of(loaded.scene.objects[0])[0][0], Vec3(10, -1, -1));
}

}  // namespace
}  // namespace microtrace::tests
