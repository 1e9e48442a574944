#include "gltf/asset_builder.hpp"
#include "io/gltf/animation/property.hpp"
#include "io/gltf/scene/scene.hpp"
#include "support/png_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNull;
using testing::NotNull;
using Numbers = std::vector<float>;

void use(AssetBuilder& asset, const char* extension) {
  Json& used = asset.json["extensionsUsed"];
  if (std::ranges::find(used, Json(extension)) == used.end()) used.push_back(extension);
}

/// Adds a channel for this JSON pointer to animation 0, with keys at 0 and 2 seconds.
void point(AssetBuilder& asset, const char* pointer, std::size_t output,
           const char* interpolation = "LINEAR") {
  use(asset, "KHR_animation_pointer");
  const std::size_t input = asset.add_numbers<float>("SCALAR", {0, 2});
  asset.animate(0, 0, "pointer", input, output, interpolation);
  Json& channels = asset.json["animations"][0]["channels"];
  channels[channels.size() - 1]["target"] = {
      {"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

void point(AssetBuilder& asset, const char* pointer, const char* shape, const Numbers& values,
           const char* interpolation = "LINEAR") {
  point(asset, pointer, asset.add_numbers<float>(shape, values), interpolation);
}

/// Adds texture 0 and texture coordinates.
void add_texture(AssetBuilder& asset) {
  asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.add_numbers<float>("VEC2", {0, 0, 1, 0, 0, 1, 1, 1, 0, 0, 1, 0, 0, 1, 1, 1});
  asset.add("textures", {{"source", 0}});
  asset.add("images", {{"mimeType", "image/png"},
                       {"bufferView", asset.add_view(png_of(1, 1, {9, 8, 7, 6}))}});
}

LoadedScene at(const AssetBuilder& asset, double time) {
  LoadedScene loaded = load(asset, {.time = time});
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
  return loaded;
}

Material material_at(const AssetBuilder& asset, double time) {
  return at(asset, time).scene.materials.at(0);
}

TEST(GltfAnimationPointer, MaterialFactorsChange) {
  AssetBuilder asset = cube();
  asset.json["materials"][0]["normalTexture"] = {{"index", 0}};
  asset.json["materials"][0]["occlusionTexture"] = {{"index", 0}};
  add_texture(asset);
  point(asset, "/materials/0/pbrMetallicRoughness/baseColorFactor", "VEC4",
        {0, 0, 0, 1, 1, 0.5F, 0.25F, 0});
  point(asset, "/materials/0/pbrMetallicRoughness/roughnessFactor", "SCALAR", {0.25F, 0.75F},
        "STEP");
  point(asset, "/materials/0/emissiveFactor", "VEC3",
        {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0}, "CUBICSPLINE");
  point(asset, "/materials/0/alphaCutoff", "SCALAR", {0, 1});
  point(asset, "/materials/0/normalTexture/scale", "SCALAR", {-2, 2});
  point(asset, "/materials/0/occlusionTexture/strength", "SCALAR", {0, 1});
  const Material material = material_at(asset, 0.5);
  EXPECT_EQ(material.base_color, Vec4(0.25F, 0.125F, 0.0625F, 0.75F));
  EXPECT_EQ(material.roughness, 0.25F);
  EXPECT_EQ(material.metallic, 1);
  EXPECT_EQ(material.emissive, Vec3(3 * 0.0625F - 2 * 0.015625F));
  EXPECT_EQ(material.alpha_cutoff, 0.25F);
  EXPECT_EQ(material.normal_scale, -1);
  EXPECT_EQ(material.occlusion_strength, 0.25F);
  EXPECT_EQ(material_at(asset, 2).roughness, 0.75F);
  EXPECT_EQ(load(asset).scene.materials.at(0).base_color, Vec4(1, 0.25F, 0.125F, 1));
}

TEST(GltfAnimationPointer, ValuesStayInTheRangeOfTheirProperty) {
  AssetBuilder asset = cube();
  use(asset, "KHR_materials_ior");
  asset.json["materials"][0]["extensions"]["KHR_materials_ior"] = Json::object();
  point(asset, "/materials/0/pbrMetallicRoughness/baseColorFactor", "VEC4",
        {-1, 2, 0.5F, 1, -1, 2, 0.5F, 1});
  point(asset, "/materials/0/extensions/KHR_materials_ior/ior", "SCALAR", {0.5F, 2});
  EXPECT_EQ(material_at(asset, 1).base_color, Vec4(0, 1, 0.5F, 1));
  EXPECT_EQ(material_at(asset, 0).ior, 1);
  EXPECT_EQ(material_at(asset, 2).ior, 2);
}

TEST(GltfAnimationPointer, InvisibleLayersMayAppear) {
  AssetBuilder asset = cube();
  for (const char* name : {"KHR_materials_transmission", "KHR_materials_anisotropy"}) {
    use(asset, name);
  }
  Numbers normals;
  for (int i = 0; i < 8; ++i) normals.insert(normals.end(), {0, 0, 1});
  asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      asset.add_numbers<float>("VEC3", normals);
  asset.json["materials"][0]["extensions"] = {
      {"KHR_materials_transmission", {{"transmissionTexture", {{"index", 0}}}}},
      {"KHR_materials_anisotropy", Json::object()}};
  add_texture(asset);
  point(asset, "/materials/0/extensions/KHR_materials_transmission/transmissionFactor", "SCALAR",
        {0, 1});
  point(asset, "/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength", "SCALAR",
        {0, 1});
  const auto scene_at = [&](double time) { return load(asset, {.time = time}).scene; };
  const Scene scene = scene_at(1);
  EXPECT_EQ(scene.materials.at(0).transmission.value().factor, 0.5F);
  EXPECT_EQ(scene.materials.at(0).anisotropy.value().strength, 0.5F);
  EXPECT_THAT(scene.images.at(0), NotNull());
  EXPECT_FALSE(std::get<Mesh>(scene.objects.at(0).shape).tangents.empty());
  EXPECT_FALSE(scene_at(0).materials.at(0).transmission);
  EXPECT_FALSE(load(asset).scene.materials.at(0).anisotropy);
}

TEST(GltfAnimationPointer, TextureTransformsChange) {
  AssetBuilder asset = cube();
  use(asset, "KHR_texture_transform");
  asset.json["materials"][0]["emissiveTexture"] = {
      {"index", 0}, {"extensions", {{"KHR_texture_transform", Json::object()}}}};
  add_texture(asset);
  const std::string base = "/materials/0/emissiveTexture/extensions/KHR_texture_transform/";
  point(asset, (base + "offset").c_str(), "VEC2", {0, 0, 4, -8});
  point(asset, (base + "scale").c_str(), "VEC2", {1, 1, 3, 5});
  EXPECT_EQ(material_at(asset, 1).emissive_texture.value().texture_from_uv,
            Mat3x2(2, 0, 0, 3, 2, -4));
  point(asset, (base + "rotation").c_str(), "SCALAR", {0, std::numbers::pi_v<float>});
  const Mat3x2 turned = material_at(asset, 1).emissive_texture.value().texture_from_uv;
  EXPECT_NEAR(turned[0].y, -2, 1e-6);
  EXPECT_NEAR(turned[1].x, 3, 1e-6);
}

TEST(GltfAnimationPointer, CamerasChange) {
  AssetBuilder asset = cube();
  asset.add("cameras",
            {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}, {"zfar", 9}}}});
  asset.add("cameras", {{"type", "orthographic"},
                        {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}});
  for (int i : {0, 1}) {
    asset.json["scenes"][0]["nodes"].push_back(asset.add("nodes", {{"camera", i}}));
  }
  point(asset, "/cameras/0/perspective/yfov", "SCALAR", {0.5F, 1.5F});
  point(asset, "/cameras/0/perspective/znear", "SCALAR", {1, 19});
  point(asset, "/cameras/0/perspective/aspectRatio", "SCALAR", {1, 3});
  point(asset, "/cameras/1/orthographic/xmag", "SCALAR", {0, 4});
  point(asset, "/cameras/1/orthographic/zfar", "SCALAR", {-1, 5});
  const auto cameras = [&](double time) { return at(asset, time).scene.cameras; };
  const auto perspective = std::get<PerspectiveCamera>(cameras(0.5).at(0).camera);
  EXPECT_EQ(perspective.vertical_fov, 0.75);
  EXPECT_EQ(perspective.depth.near, 5.5);
  EXPECT_EQ(perspective.depth.far, 9);
  EXPECT_EQ(perspective.aspect_ratio, 1.5);
  EXPECT_EQ(std::get<PerspectiveCamera>(cameras(2).at(0).camera).depth.far,
            std::numeric_limits<double>::infinity());
  const auto orthographic = std::get<OrthographicCamera>(cameras(1).at(1).camera);
  EXPECT_EQ(orthographic.aspect_ratio, 2);
  EXPECT_EQ(orthographic.height, 2);
  EXPECT_EQ(orthographic.depth.far, 2);
  const auto flat = std::get<OrthographicCamera>(cameras(0).at(1).camera);
  EXPECT_GT(flat.aspect_ratio, 0);
  EXPECT_GT(flat.depth.far, flat.depth.near);
}

TEST(GltfAnimationPointer, RepairedCamerasKeepTheirOtherProperties) {
  std::string text = R"({"cameras": [{"perspective": {"zfar": 1, "znear": 2, "yfov": 3)";
  for (int i = 0; i < 20; ++i) text += ", \"a" + std::to_string(i) + "\": 0";
  text += "}}]}";
  const io::JsonDocument document(text, "test.gltf");
  io::JsonValue part = io::gltf::animated_part(document.root());
  io::gltf::repair_properties(part);
  const io::JsonValue& camera = *part.find("cameras")->items().at(0).find("perspective");
  EXPECT_THAT(camera.find("zfar"), IsNull());
  ASSERT_THAT(camera.find("znear"), NotNull());
  EXPECT_EQ(camera.find("znear")->number(), 2);
  ASSERT_THAT(camera.find("yfov"), NotNull());
  EXPECT_EQ(camera.find("yfov")->number(), 3);
}

TEST(GltfAnimationPointer, FieldOfViewStaysBelowPi) {
  AssetBuilder asset = cube();
  asset.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  asset.json["scenes"][0]["nodes"].push_back(asset.add("nodes", {{"camera", 0}}));
  point(asset, "/cameras/0/perspective/yfov", "SCALAR", {-4, 4});
  const auto fov = [&](double time) {
    return std::get<PerspectiveCamera>(at(asset, time).scene.cameras.at(0).camera).vertical_fov;
  };
  EXPECT_GT(fov(0), 0);
  EXPECT_LT(fov(2), std::numbers::pi);
}

AssetBuilder with_spot_light(double inner_angle) {
  AssetBuilder asset = cube();
  use(asset, "KHR_lights_punctual");
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"innerConeAngle", inner_angle}, {"outerConeAngle", 0.75}}}}};
  asset.json["scenes"][0]["nodes"].push_back(
      asset.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
  return asset;
}

TEST(GltfAnimationPointer, LightsChange) {
  AssetBuilder asset = with_spot_light(0.5);
  const std::string light = "/extensions/KHR_lights_punctual/lights/0/";
  point(asset, (light + "color").c_str(), "VEC3", {1, 1, 1, 0, 0.5F, 1});
  point(asset, (light + "intensity").c_str(), "SCALAR", {-10, 30});
  point(asset, (light + "range").c_str(), "SCALAR", {2, 4});
  point(asset, (light + "spot/outerConeAngle").c_str(), "SCALAR", {0.25F, 1.25F});
  const auto spot = [&](double time) {
    return std::get<SpotLight>(at(asset, time).scene.lights.at(0).light);
  };
  EXPECT_EQ(spot(1).color, Vec3(0.5F, 0.75F, 1));
  EXPECT_EQ(spot(1).intensity, 10);
  EXPECT_EQ(spot(0).intensity, 0);
  EXPECT_EQ(spot(1).range, 3);
  EXPECT_EQ(spot(1).outer_angle, 0.75);
  EXPECT_EQ(spot(1).inner_angle, 0.5);
  EXPECT_EQ(spot(0).outer_angle, 0.25);
  EXPECT_LT(spot(0).inner_angle, 0.25);
  EXPECT_EQ(std::get<SpotLight>(load(asset).scene.lights.at(0).light).range,
            std::numeric_limits<double>::infinity());
}

// Blender 5.0 writes a dot instead of the second slash.
TEST(GltfAnimationPointer, AcceptsTheAnglesOfBlender) {
  AssetBuilder asset = with_spot_light(0.125);
  const char* pointer = "/extensions/KHR_lights_punctual/lights/0/spot.outerConeAngle";
  point(asset, pointer, "SCALAR", {0.25F, 1.25F});
  const LoadedScene loaded = load(asset, {.time = 1});
  EXPECT_EQ(std::get<SpotLight>(loaded.scene.lights.at(0).light).outer_angle, 0.75);
  EXPECT_EQ(std::get<SpotLight>(load(asset, {.time = 0}).scene.lights.at(0).light).outer_angle,
            0.25);
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("/lights/0/spot/outerConeAngle")));
}

TEST(GltfAnimationPointer, NodesAppearAndDisappear) {
  AssetBuilder asset = cube();
  use(asset, "KHR_node_visibility");
  asset.json["nodes"][0]["extensions"]["KHR_node_visibility"] = {{"visible", false}};
  const std::size_t shown = asset.add_numbers<std::uint8_t>("SCALAR", {1, 0});
  point(asset, "/nodes/0/extensions/KHR_node_visibility/visible", shown, "STEP");
  const auto triangles_at = [&](std::optional<double> time) {
    const LoadedScene loaded = load(asset, {.time = time});
    const std::size_t triangles =
        loaded.scene.objects.empty()
            ? 0
            : std::get<Mesh>(loaded.scene.objects.at(0).shape).triangles.size();
    const bool warns = std::ranges::any_of(texts(loaded.warnings), [](const std::string& text) {
      return text.find("nothing to draw") != std::string::npos;
    });
    EXPECT_EQ(warns, triangles == 0);
    return triangles;
  };
  EXPECT_EQ(triangles_at(0), 12U);
  EXPECT_EQ(triangles_at(1.99), 12U);
  EXPECT_EQ(triangles_at(2), 0U);
  EXPECT_EQ(triangles_at(std::nullopt), 0U);
  EXPECT_TRUE(load(asset).scene.objects.empty());
}

TEST(GltfAnimationPointer, HiddenNodesKeepTheNumbersAndNamesOfOthers) {
  AssetBuilder asset = cube();
  use(asset, "KHR_node_visibility");
  use(asset, "EXT_mesh_gpu_instancing");
  const Json visible = {{"visible", true}}, hidden = {{"visible", false}};
  asset.json["nodes"][0] = {{"children", {1, 2}},
                            {"extensions", {{"KHR_node_visibility", visible}}}};
  const std::size_t places = asset.add_numbers<float>("VEC3", {0, 0, 0, 3, 0, 0});
  asset.add(
      "nodes",
      {{"name", "twin"},
       {"mesh", 0},
       {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  asset.add("nodes",
            {{"name", "never"}, {"mesh", 0}, {"extensions", {{"KHR_node_visibility", hidden}}}});
  asset.add("nodes", {{"name", "same"}, {"mesh", 0}});
  asset.add("nodes", {{"name", "same"}, {"mesh", 0}});
  asset.json["nodes"][3]["extensions"]["KHR_node_visibility"] = visible;
  asset.json["scenes"][0]["nodes"] = {0, 3, 4};
  for (const char* node : {"0", "3"}) {
    const std::string pointer =
        std::string("/nodes/") + node + "/extensions/KHR_node_visibility/visible";
    point(asset, pointer.c_str(), asset.add_numbers<std::uint8_t>("SCALAR", {1, 0}), "STEP");
  }
  const auto names_at = [&](double time) {
    std::vector<std::string> names;
    for (const Object& object : at(asset, time).scene.objects) names.push_back(object.name.str());
    return names;
  };
  EXPECT_EQ(names_at(0).size(), 4U);
  EXPECT_EQ(names_at(2), names_at(0));
  const Scene scene = at(asset, 2).scene;
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(std::get<Mesh>(scene.objects.at(i).shape).triangles.empty(), i < 3) << i;
}

TEST(GltfAnimationPointer, IntegersMayBeNormalizedOrNot) {
  AssetBuilder asset = cube();
  point(asset, "/materials/0/pbrMetallicRoughness/metallicFactor",
        asset.add_numbers<std::uint8_t>("SCALAR", {0, 51}, true));
  point(asset, "/materials/0/alphaCutoff", asset.add_numbers<std::uint16_t>("SCALAR", {0, 4}));
  EXPECT_FLOAT_EQ(material_at(asset, 2).metallic, 0.2F);
  EXPECT_EQ(material_at(asset, 1).alpha_cutoff, 2);
}

TEST(GltfAnimationPointer, IntegersMoveNodes) {
  AssetBuilder asset = cube();
  point(asset, "/nodes/0/translation",
        asset.add_numbers<std::int16_t>("VEC3", {0, 0, 0, 4, -2, 6}));
  const auto corner = [&](double time) {
    return std::get<Mesh>(at(asset, time).scene.objects.at(0).shape).position(0);
  };
  EXPECT_EQ(corner(1) - corner(0), Vec3(2, -1, 3));
}

TEST(GltfAnimationPointer, NodesIgnoreValuesOfAnotherType) {
  for (const char* pointer : {"/nodes/0/translation", "/nodes/0/rotation", "/nodes/0/scale"}) {
    for (const char* type : {"SCALAR", "VEC2"}) {
      AssetBuilder asset = cube();
      point(asset, pointer, type, {1, 2, 3, 4});
      EXPECT_THAT(texts(load(asset, {.time = 1}).warnings),
                  ElementsAre(HasSubstr(
                      "/animations/0/samplers/0/output: has a type or number of elements")))
          << pointer << type;
    }
  }
}

TEST(GltfAnimationPointer, PointersToNothingGiveWarnings) {
  for (const char* pointer :
       {"/materials/1/alphaCutoff", "/materials/0/alphaMode", "/materials/0/doubleSided",
        "/materials/0/normalTexture/scale", "/materials/0/extensions/KHR_materials_ior/ior",
        "/materials/0/pbrMetallicRoughness", "/materials/0/pbrMetallicRoughness/baseColorFactor/0",
        "/materials/alphaCutoff", "/materials/0/extensions", "/cameras/0/perspective/yfov",
        "/nodes/0/extensions/KHR_node_visibility/visible", "/asset/version", "/accessors/0/count",
        "/extensions/KHR_lights_punctual/lights/0/color", "/nodes/0/matrix", "//", "materials",
        "/nodes/00/translation"}) {
    AssetBuilder asset = cube();
    point(asset, pointer, "SCALAR", {0, 1});
    const LoadedScene loaded = load(asset, {.time = 1});
    EXPECT_THAT(texts(loaded.warnings),
                ElementsAre(HasSubstr("/target/extensions/KHR_animation_pointer/pointer: ")))
        << pointer;
    EXPECT_EQ(color_of(loaded, 0), Vec4(1, 0.25F, 0.125F, 1)) << pointer;
  }
}

TEST(GltfAnimationPointer, IgnoresValuesOfAnotherSize) {
  const auto expect_ignored = [](const AssetBuilder& asset) {
    const LoadedScene loaded = load(asset, {.time = 1});
    EXPECT_THAT(texts(loaded.warnings),
                ElementsAre(HasSubstr(
                    "/animations/0/samplers/0/output: has a type or number of elements")));
    EXPECT_EQ(color_of(loaded, 0), Vec4(1, 0.25F, 0.125F, 1));
  };
  const char* color = "/materials/0/pbrMetallicRoughness/baseColorFactor";
  AssetBuilder narrow = cube();
  point(narrow, color, "VEC3", {0, 0, 0, 1, 1, 1});
  expect_ignored(narrow);
  AssetBuilder few = cube();
  point(few, color, "VEC4", {0, 0, 0, 0, 1, 1, 1, 1}, "CUBICSPLINE");
  expect_ignored(few);
  for (const bool is_step : {false, true}) {
    AssetBuilder smooth = cube();
    use(smooth, "KHR_node_visibility");
    smooth.json["nodes"][0]["extensions"]["KHR_node_visibility"] = Json::object();
    const std::size_t output = is_step ? smooth.add_numbers<float>("SCALAR", {0, 0})
                                       : smooth.add_numbers<std::uint8_t>("SCALAR", {0, 0});
    point(smooth, "/nodes/0/extensions/KHR_node_visibility/visible", output,
          is_step ? "STEP" : "LINEAR");
    expect_ignored(smooth);
  }
}

// Loads several poses of one file, as rendering a sequence of frames does.
TEST(GltfAnimationPointer, OneFileGivesManyPoses) {
  AssetBuilder asset = cube();
  point(asset, "/materials/0/pbrMetallicRoughness/roughnessFactor", "SCALAR", {0, 1});
  const std::string bytes = asset.glb();
  io::GltfFile file(bytes, "test.glb", "");
  const auto roughness = [&](std::optional<double> time) {
    return file.at(time).scene.materials.at(0).roughness;
  };
  EXPECT_EQ(roughness(2), 1);
  EXPECT_EQ(roughness(0.5), 0.25F);
  EXPECT_EQ(roughness(std::nullopt), 1);
  EXPECT_EQ(roughness(0), 0);
  EXPECT_EQ(roughness(0.5), 0.25F);
}

}  // namespace
}  // namespace microtrace::tests
