#include "gltf/asset_builder.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A violation of the specification that causes only a warning, so the asset can still be rendered.
/// `where` and `value` are arguments of mutated().
struct Survived {
  const char* where;
  const char* value;
  const char* pointer;
  const char* message;
};

const Survived kSurvived[] = {
    // The asset as a whole
    {"/asset/version", "\"2.1\"", "/asset/version", "read as glTF 2.0"},
    {"/asset/minVersion", "\"2.1\"", "/asset/minVersion", "greater than version"},
    {"/asset", R"({"version": "2.1", "minVersion": "2.1"})", "/asset/minVersion",
     "features of later versions"},
    {"/extensionsRequired", R"(["X_a"])", "/extensionsRequired/0", "missing from extensionsUsed"},
    {"/extensionsUsed", "[]", "/extensionsUsed", "is empty"},
    {"/extensionsUsed", R"(["X_a", "X_b", "X_a"])", "/extensionsUsed/2", "repeats an earlier item"},
    {"/extensionsUsed", R"(["KHR_mesh_quantization"])", "/extensionsUsed/0",
     "must also be listed in extensionsRequired"},
    {"", R"({"extensionsUsed": ["KHR_mesh_quantization"],
             "extensionsRequired": ["KHR_mesh_quantization"],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                            "min": [-1, -1, -1], "max": [1, 1, 1],
                            "extensions": {"KHR_mesh_quantization": {}}},
                           {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]})",
     "/accessors/0/extensions/KHR_mesh_quantization", "does not belong in this object"},
    {"/extensions", R"({"X_a": {}})", "/extensions/X_a", "not declared"},
    {"", R"({"extensionsUsed": ["KHR_materials_unlit"],
             "extensions": {"KHR_materials_unlit": {}}})",
     "/extensions/KHR_materials_unlit", "does not belong in this object"},
    {"", R"({"extensionsUsed": ["KHR_lights_punctual"],
             "nodes": [{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}]})",
     "/nodes/0/extensions/KHR_lights_punctual/light", "absent"},

    // Unknown enumeration values
    {"/bufferViews/0/target", "1", "/bufferViews/0/target", "must be one of"},
    {"/materials/0/alphaMode", "\"GLASS\"", "/materials/0/alphaMode", "must be one of"},
    {"/samplers", R"([{"wrapS": 1, "minFilter": 2}])", "/samplers/0/wrapS", "must be one of"},

    // Null values
    {"/skins", "null", "/skins", "is null"},
    {"/meshes/0/primitives/0/material", "null", "/meshes/0/primitives/0/material", "is null"},
    {"/meshes/0/primitives/0/attributes/NORMAL", "null", "/meshes/0/primitives/0/attributes/NORMAL",
     "is null"},
    {"/nodes/0/name", "null", "/nodes/0/name", "is null"},
    {"/nodes/0/extensions", "null", "/nodes/0/extensions", "is null"},
    {"/nodes/0/extensions", R"({"X_a": null})", "/nodes/0/extensions/X_a", "is null"},
    {"/accessors/0/max", "[null, 1, 1]", "/accessors/0/max/0", "the whole property is"},
    {"/nodes/0/translation", "[0, null, 0]", "/nodes/0/translation/1", "the whole property is"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[null, null, null, 1]",
     "/materials/0/pbrMetallicRoughness/baseColorFactor/0", "the whole property is"},
    {"/cameras", R"([{"type": "orthographic", "orthographic":
                     {"xmag": 1, "ymag": 1, "znear": 0, "zfar": null}}])",
     "/cameras/0/orthographic/zfar", "must be greater than znear; the camera is left out"},

    // Empty accessors, and names of images
    {"/accessors/0/count", "0", "/accessors/0/count", "must be at least 1"},
    {"/accessors/1/count", "0", "/accessors/1/count", "must be at least 1"},
    {"/images", R"([{"uri": "100% wood.png"}])", "/images/0/uri", "which is read as it is"},

    // Numbers out of range
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1.00000012, 1, 1]",
     "/materials/0/pbrMetallicRoughness/baseColorFactor/1", "must be a number"},
    {"/materials/0/emissiveFactor", "[0, 0, 7]", "/materials/0/emissiveFactor/2", "nearest"},
    {"/materials/0/alphaCutoff", "-1", "/materials/0/alphaCutoff", "nearest"},
    {"/nodes/0/rotation", "[0, 0, 0, 1.0000001]", "/nodes/0/rotation/3", "at most 1"},
    {"/nodes/0/rotation", "[0, 0, 0, 2]", "/nodes/0/rotation", "it is normalized"},
    {"/nodes/0/rotation", "[0, 0, 0, 0]", "/nodes/0/rotation", "must be a unit quaternion"},

    // Accessors and attributes
    {"/accessors/0/type", "\"VEC2\"", "/accessors/0/max", "must have 2 items, has 3"},
    {"/accessors/0/min", "[0, 0]", "/accessors/0/min", "must have 3 items, has 2"},
    {"/accessors/0/max", "[]", "/accessors/0/max", "must have 3 items, has 0"},
    {"/meshes/0/primitives/0/attributes", R"({"position": 0})",
     "/meshes/0/primitives/0/attributes/position", "is not a glTF 2.0 attribute"},
    {"/meshes/0/primitives/0/attributes/_X", "1", "/meshes/0/primitives/0/attributes/_X",
     "has 36 elements, but POSITION has 8"},

    // Cameras
    {"/cameras", R"([{"type": "perspective"}])", "/cameras/0", "the camera is left out"},
    {"/cameras", R"([{"type": "perspective", "perspective": {"yfov": 0, "znear": 1}}])",
     "/cameras/0/perspective/yfov", "the camera is left out"},
    {"/cameras", R"([{"type": "perspective", "perspective": {"yfov": 3.15, "znear": 1}}])",
     "/cameras/0/perspective/yfov", "the camera is left out"},
    {"/cameras", R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0}}])",
     "/cameras/0/perspective/znear", "above 0"},
    {"/cameras", R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1, "zfar": 1}}])",
     "/cameras/0/perspective/zfar", "it is ignored"},
    {"/cameras",
     R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1, "aspectRatio": 0}}])",
     "/cameras/0/perspective/aspectRatio", "it is ignored"},
    {"/cameras",
     R"([{"type": "orthographic", "orthographic": {"xmag": 0, "ymag": 1, "znear": 0, "zfar": 1}}])",
     "/cameras/0/orthographic/xmag", "the camera is left out"},
    {"/cameras",
     R"([{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 1, "zfar": 1}}])",
     "/cameras/0/orthographic/zfar", "the camera is left out"},
    {"/cameras",
     R"([{"type": "orthographic", "perspective": {"yfov": 1, "znear": 1},
          "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}])",
     "/cameras/0/perspective", "the other type"},

    // Buffers
    {"/bufferViews/0/byteStride", "0", "/bufferViews/0/byteStride", "tightly packed"},
    {"/bufferViews", R"([{"buffer": 0, "byteLength": 96},
                         {"buffer": 0, "byteOffset": 96, "byteLength": 72},
                         {"buffer": 0, "byteLength": 0}])",
     "/bufferViews/2/byteLength", "at least 1"},
    {"/buffers/1", R"({"uri": "data:application/octet-stream;base64,", "byteLength": 0})",
     "/buffers/1/byteLength", "at least 1"},
    {"/buffers/0/uri", "", "/buffers/0", "has no uri"},

    // Scenes
    {"/scenes/0/nodes", "[0, 0]", "/scenes/0/nodes/1", "repeats an earlier item"},
    {"/nodes/0",
     R"({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "scale": [1, 1, 1]})",
     "/nodes/0/scale", "must not be combined with a matrix"},
    {"/scenes/0/nodes", "[]", "/scenes/0/nodes", "is empty"},
    {"/nodes/0/matrix", "[1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]", "/nodes/0/matrix",
     "is not affine"},
    {"/meshes/0/primitives", "[]", "/meshes/0/primitives", "is empty"},
};

TEST(GltfSurvived, EveryMutationIsDrawnWithAWarningAtItsPointer) {
  for (const auto& [where, value, pointer, message] : kSurvived) {
    SCOPED_TRACE(std::string(where) + " = " + value);
    EXPECT_THAT(texts(load(mutated(cube(), where, value)).warnings),
                Contains(AllOf(HasSubstr(std::string(pointer) + ": "), HasSubstr(message))));
  }
}

TEST(GltfSurvived, IgnoresCamerasOfUnknownType) {
  AssetBuilder asset = cube();
  asset.json["cameras"] = {{{"type", "fisheye"}}};
  asset.json["nodes"][0]["camera"] = 0;
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), Contains(HasSubstr("/cameras/0/type: must be one of")));
  EXPECT_THAT(loaded.scene.cameras, IsEmpty());
}

TEST(GltfSurvived, PrimitiveRestartStartsANewPrimitive) {
  for (const auto& [type, kPrimitiveRestart] :
       {std::pair{kUint8, 0xFFU}, std::pair{kUint16, 0xFFFFU}, std::pair{kUint32, 0xFFFFFFFFU}}) {
    AssetBuilder asset;
    const std::size_t positions = asset.add_positions({Vec3(0), Vec3(1), Vec3(2), Vec3(3)});
    const std::size_t indices = asset.add_indices({0, 1, 2, kPrimitiveRestart, 1, 2, 3}, type);
    asset.add_object(
        {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", 5}});
    const LoadedScene loaded = load(asset);
    EXPECT_THAT(texts(loaded.warnings),
                Contains(HasSubstr("/accessors/1: has the primitive restart value")));
    const auto triangles = triangles_of(loaded.scene.objects.at(0));
    ASSERT_THAT(triangles, SizeIs(2));
    EXPECT_EQ(triangles[1][0], Vec3(1));
    EXPECT_EQ(triangles[1][2], Vec3(3));
  }
}

TEST(GltfSurvived, ChildListedAsSceneRootStaysUnderItsParent) {
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
