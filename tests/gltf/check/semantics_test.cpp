#include "gltf/rig.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;

/// A change to the rig, as made by mutated(). If `pointer` is null, messages must point to `where`.
struct Change {
  const char* where;
  const char* value;
  const char* pointer = nullptr;

  [[nodiscard]] std::string place() const { return pointer != nullptr ? pointer : where; }
};

constexpr const char* kAttributes = "/meshes/0/primitives/0/attributes";

const Change kRefused[] = {
    // Meshes
    {"/meshes/0/primitives/0/indices", "10"},

    // Skins
    {"/skins/0/inverseBindMatrices", "0"},
    {"/skins/0/inverseBindMatrices", "99"},
    {"/skins/0/joints", "[1, 2, 3]", "/skins/0/inverseBindMatrices"},
    {"/skins/0/skeleton", "4"},

    // Animations
    {"/animations/0/channels/0/sampler", "3"},
    {"/animations/0/channels/0/target/node", "9"},
    {"/animations/0/channels/0/target", "{}"},
    {"/animations/0/channels/0/target/path", "7"},

    // Materials, textures and lights
    {"/textures/0/source", "1"},
    {"/textures/0/sampler", "1"},
    {"/images/0/uri", "\"a.png\"", "/images/0"},
    {"/images/0/bufferView", "", "/images/0"},
    {"/extensions/KHR_lights_punctual/lights/0/type", "",
     "/extensions/KHR_lights_punctual/lights/0"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "[1, 1]"},
    {"/nodes/3/extensions/KHR_lights_punctual/light", "1"},
    {"/nodes/3/extensions/KHR_lights_punctual/light", "",
     "/nodes/3/extensions/KHR_lights_punctual"},
    {"/extensions/KHR_materials_variants/variants/0/name", "",
     "/extensions/KHR_materials_variants/variants/0"},
    {"/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants/0", "2"},
    {"/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material", "1"},
    {"/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings", "",
     "/meshes/0/primitives/0/extensions/KHR_materials_variants"},
};

const Change kSurvivedChanges[] = {
    {"/meshes/0/primitives/0/attributes/TEXCOORD_01", "3"},
    {"/meshes/0/primitives/0/attributes/TEXCOORD_", "3"},
    {"/meshes/0/primitives/0/attributes/JOINTS", "5"},
    {"/meshes/0/primitives/0/attributes/color", "4"},
    {"/meshes/0/primitives/0/attributes/WEIGHTS_0", "", kAttributes},
    {"/meshes/0/primitives/0/attributes/JOINTS_1", "5", kAttributes},
    {"/meshes/0/primitives/0/attributes/NORMAL", "11"},
    {"/meshes/0/primitives/0/targets/0", R"({"JOINTS_0": 5})",
     "/meshes/0/primitives/0/targets/0/JOINTS_0"},
    {"/meshes/0/primitives/0/targets/0", R"({"POSITION": 11})",
     "/meshes/0/primitives/0/targets/0/POSITION"},
    {"/meshes/0/primitives/0/targets/0", R"({"TEXCOORD_1": 3})",
     "/meshes/0/primitives/0/targets/0/TEXCOORD_1"},
    {"/meshes/0/primitives/1", R"({"attributes": {"POSITION": 0}})"},
    {"/animations/0/samplers/0/input", "0"},
    {"/animations/0/samplers/0/output", "10"},
    {"/animations/0/samplers/0/output", "0"},
    {"/animations/0/samplers/1/output", "11"},
    {"/animations/0/samplers/0/interpolation", "\"CUBICSPLINE\"",
     "/animations/0/samplers/0/output"},
    {"/animations/0/channels/2/target/node", "1"},
    {"/nodes/1/matrix", "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]",
     "/animations/0/channels/0/target/node"},
    {"/accessors/10/max", "[1, 2]"},
    {"/materials/0/extensions/KHR_materials_ior/ior", "0.5"},
    {"/materials/0/extensions/KHR_materials_ior/ior", "-1"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "-1"},
    {"/extensions/KHR_lights_punctual/lights/0/spot", "",
     "/extensions/KHR_lights_punctual/lights/0"},
    {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", "0.8"},
    {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", "1.6"},
    {"/extensions/KHR_lights_punctual/lights/0/intensity", "-1"},
    {"/skins/0/joints", "[1, 1]", "/skins/0/joints/1"},
    {"/images/0/mimeType", "\"image/webp\""},

    // Meshes
    {"/meshes/0/primitives/0/attributes/TEXCOORD_2", "3", kAttributes},
    {"/meshes/0/primitives/0/attributes/TEXCOORD_0", "1"},
    {"/meshes/0/primitives/0/attributes/_IDS", "14"},
    {"/meshes/0/primitives/0/attributes/_IDS", "15"},
    {"/accessors/0/max", "", "/accessors/0"},
    {"/accessors/3/normalized", "true"},
    {"/meshes/0/weights", "[0, 1]"},
    {"/meshes/0/primitives/0/targets/0", "{}"},
    {"/materials/0/normalTexture", R"({"index": 0, "texCoord": 3})",
     "/meshes/0/primitives/0/material"},
    {"/bufferViews/1/target", "34963", "/meshes/0/primitives/0/attributes/NORMAL"},
    {"/bufferViews/9/target", "34962", "/skins/0/inverseBindMatrices"},
    {"/accessors/1/bufferView", "0", "/meshes/0/primitives/0/attributes/POSITION"},
    {"/bufferViews/9/byteStride", "64", "/skins/0/inverseBindMatrices"},

    // Nodes and skins
    {"/nodes/0/rotation", "[0, 0, 0.5, 0.5]"},
    {"/nodes/0/weights", "[1, 2, 3]"},
    {"/nodes/2/weights", "[1]"},
    {"/nodes/2/skin", "0"},
    {"/nodes/0/matrix", "[1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"},
    {"/scenes/0/nodes", "[0, 1, 2, 3]", "/scenes/0/nodes/2"},
    {"/scenes/0/nodes", "[0, 3]", "/nodes/0/skin"},
    {"/skins/0/joints", "[1, 3]"},
    {"/skins/0/skeleton", "2"},

    // Animations
    {"/animations/0/channels/1", R"({"sampler": 0, "target": {"node": 1, "path": "translation"}})",
     "/animations/0/channels/1/target"},
    {"/animations/0/channels/0/target/path", "\"colour\""},
    {"/animations/0/samplers/0/interpolation", "\"CUBIC\""},
    {"/accessors/10/min", "", "/accessors/10"},

    // Materials, textures and lights
    {"/images/0/mimeType", "", "/images/0"},
    {"/images/0/mimeType", "\"image/webp\"", "/textures/0/source"},
    {"/extensions/KHR_lights_punctual/lights/0/type", "\"sun\""},
    {"/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/1/variants", "[0]",
     "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/1/variants/0"},
    {"/extensionsUsed", R"(["KHR_lights_punctual", "KHR_materials_ior"])",
     "/extensions/KHR_materials_variants"},
};

TEST(GltfSemantics, TheUnchangedRigIsValid) {
  // The valid rig has only warnings about unsupported features.
  EXPECT_THAT(texts(load(rig()).warnings),
              Each(testing::AnyOf(HasSubstr("not drawn"), HasSubstr("ignored"), HasSubstr("yet"),
                                  HasSubstr("not supported"))));
}

TEST(GltfSemantics, InvalidAssetsAreRefusedAtTheirPointer) {
  for (const Change& change : kRefused) {
    SCOPED_TRACE(std::string(change.where) + " = " + change.value);
    try {
      (void)load(mutated(rig(), change.where, change.value));
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene) << error.what();
      EXPECT_EQ(error.diagnostic().pointer, change.place()) << error.what();
    }
  }
}

TEST(GltfSemantics, HarmlessViolationsGiveWarningsAtTheirPointer) {
  for (const Change& change : kSurvivedChanges) {
    SCOPED_TRACE(std::string(change.where) + " = " + change.value);
    AssetBuilder asset = rig();
    // Accessors 14 and 15 have types that vertex attributes must not have. Some changes use them
    // for an application-specific attribute.
    asset.add("accessors", {{"componentType", kUint32}, {"count", 3}, {"type", "SCALAR"}});
    asset.add("accessors",
              {{"bufferView", 0}, {"componentType", kFloat32}, {"count", 3}, {"type", "VEC5"}});
    EXPECT_THAT(texts(load(mutated(asset, change.where, change.value)).warnings),
                Contains(HasSubstr(change.place() + ": ")));
  }
}

}  // namespace
}  // namespace microtrace::tests
