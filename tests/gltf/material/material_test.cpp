#include "gltf/asset_builder.hpp"
#include "scene/material_textures.hpp"
#include "scene/mesh/merge.hpp"
#include "support/png_file.hpp"

#include <limits>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Returns the cube with this material. All its extensions are declared, and 24 textures with
/// different images exist.
AssetBuilder with_material(const char* material) {
  AssetBuilder asset = cube();
  asset.json["materials"][0] = Json::parse(material);
  for (const auto& [name, object] : asset.json["materials"][0]["extensions"].members()) {
    asset.json["extensionsUsed"].push_back(name);
    asset.json["extensionsRequired"].push_back(name);
  }
  asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.add_numbers("VEC2", std::vector<float>(16));
  const std::size_t view = asset.add_view(png_of(1, 1, {9, 8, 7, 6}));
  for (int i = 0; i < 24; ++i) {
    asset.add("textures", {{"source", i}});
    asset.add("images", {{"mimeType", "image/png"}, {"bufferView", view}});
  }
  return asset;
}

Material material(const char* json) {
  return load(with_material(json)).scene.materials.at(0);
}

/// A material with all material extensions except the archived one. Its numbers and textures are
/// all different.
constexpr const char* kEverything = R"({
  "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                           "metallicRoughnessTexture": {"index": 1}},
  "normalTexture": {"index": 2}, "occlusionTexture": {"index": 3},
  "emissiveTexture": {"index": 4}, "emissiveFactor": [0.25, 0.5, 1],
  "extensions": {
    "KHR_materials_emissive_strength": {"emissiveStrength": 8},
    "KHR_materials_ior": {"ior": 1.75},
    "KHR_materials_dispersion": {"dispersion": 0.375},
    "KHR_materials_specular": {
      "specularFactor": 0.125, "specularTexture": {"index": 5},
      "specularColorFactor": [2, 0.5, 0], "specularColorTexture": {"index": 6}},
    "KHR_materials_transmission": {
      "transmissionFactor": 0.75, "transmissionTexture": {"index": 7}},
    "KHR_materials_volume": {
      "thicknessFactor": 3, "thicknessTexture": {"index": 8},
      "attenuationDistance": 0.5, "attenuationColor": [0.25, 0.5, 1]},
    "KHR_materials_volume_scatter": {
      "multiscatterColor": [0.75, 0.625, 0.5], "scatterAnisotropy": -0.25},
    "KHR_materials_clearcoat": {
      "clearcoatFactor": 0.625, "clearcoatTexture": {"index": 9},
      "clearcoatRoughnessFactor": 0.375, "clearcoatRoughnessTexture": {"index": 10},
      "clearcoatNormalTexture": {"index": 11, "scale": 0.5}},
    "KHR_materials_sheen": {
      "sheenColorFactor": [0.5, 0.25, 0.125], "sheenColorTexture": {"index": 12},
      "sheenRoughnessFactor": 0.875, "sheenRoughnessTexture": {"index": 13}},
    "KHR_materials_anisotropy": {
      "anisotropyStrength": 0.5, "anisotropyRotation": 0.25, "anisotropyTexture": {"index": 14}},
    "KHR_materials_iridescence": {
      "iridescenceFactor": 1, "iridescenceTexture": {"index": 15}, "iridescenceIor": 1.5,
      "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 800,
      "iridescenceThicknessTexture": {"index": 16}},
    "KHR_materials_diffuse_transmission": {
      "diffuseTransmissionFactor": 0.25, "diffuseTransmissionTexture": {"index": 17},
      "diffuseTransmissionColorFactor": [1, 0, 0.5],
      "diffuseTransmissionColorTexture": {"index": 18}}}})";

std::optional<std::uint32_t> index_of(const std::optional<TextureUse>& use) {
  return use ? std::optional(use->texture) : std::nullopt;
}

TEST(GltfMaterial, ExtensionsAreReadWithoutAWarning) {
  EXPECT_THAT(texts(load(with_material(kEverything)).warnings), testing::IsEmpty());
  const Material m = material(kEverything);
  EXPECT_EQ(m.emissive, Vec3(2, 4, 8));
  EXPECT_EQ(m.ior, 1.75F);
  EXPECT_EQ(m.dispersion, 0.375F);
  ASSERT_TRUE(m.specular && m.transmission && m.volume && m.volume_scatter && m.clearcoat &&
              m.sheen && m.anisotropy && m.iridescence && m.diffuse_transmission);
  EXPECT_FALSE(m.specular_glossiness);
  EXPECT_EQ(m.specular->factor, 0.125F);
  EXPECT_EQ(index_of(m.specular->texture), 5U);
  EXPECT_EQ(m.specular->color, Vec3(2, 0.5F, 0));
  EXPECT_EQ(index_of(m.specular->color_texture), 6U);
  EXPECT_EQ(m.transmission->factor, 0.75F);
  EXPECT_EQ(index_of(m.transmission->texture), 7U);
  EXPECT_EQ(m.volume->thickness, 3);
  EXPECT_EQ(index_of(m.volume->texture), 8U);
  EXPECT_EQ(m.volume->attenuation_distance, 0.5F);
  EXPECT_EQ(m.volume->attenuation_color, Vec3(0.25F, 0.5F, 1));
  EXPECT_EQ(m.volume_scatter->multiscatter_color, Vec3(0.75F, 0.625F, 0.5F));
  EXPECT_EQ(m.volume_scatter->anisotropy, -0.25F);
  EXPECT_EQ(m.clearcoat->factor, 0.625F);
  EXPECT_EQ(index_of(m.clearcoat->texture), 9U);
  EXPECT_EQ(m.clearcoat->roughness, 0.375F);
  EXPECT_EQ(index_of(m.clearcoat->roughness_texture), 10U);
  EXPECT_EQ(index_of(m.clearcoat->normal_texture), 11U);
  EXPECT_EQ(m.clearcoat->normal_scale, 0.5F);
  EXPECT_EQ(m.sheen->color, Vec3(0.5F, 0.25F, 0.125F));
  EXPECT_EQ(index_of(m.sheen->color_texture), 12U);
  EXPECT_EQ(m.sheen->roughness, 0.875F);
  EXPECT_EQ(index_of(m.sheen->roughness_texture), 13U);
  EXPECT_EQ(m.anisotropy->strength, 0.5F);
  EXPECT_EQ(m.anisotropy->rotation, 0.25F);
  EXPECT_EQ(index_of(m.anisotropy->texture), 14U);
  EXPECT_EQ(m.iridescence->factor, 1);
  EXPECT_EQ(index_of(m.iridescence->texture), 15U);
  EXPECT_EQ(m.iridescence->ior, 1.5F);
  EXPECT_EQ(m.iridescence->thickness_minimum, 200);
  EXPECT_EQ(m.iridescence->thickness_maximum, 800);
  EXPECT_EQ(index_of(m.iridescence->thickness_texture), 16U);
  EXPECT_EQ(m.diffuse_transmission->factor, 0.25F);
  EXPECT_EQ(index_of(m.diffuse_transmission->texture), 17U);
  EXPECT_EQ(m.diffuse_transmission->color, Vec3(1, 0, 0.5F));
  EXPECT_EQ(index_of(m.diffuse_transmission->color_texture), 18U);
}

TEST(GltfMaterial, ExtensionsHaveTheDefaultsOfTheirSpecifications) {
  const Material m = material(R"({"emissiveFactor": [1, 1, 1], "extensions": {
    "KHR_materials_emissive_strength": {}, "KHR_materials_ior": {}, "KHR_materials_dispersion": {},
    "KHR_materials_specular": {},
    "KHR_materials_volume": {"thicknessFactor": 1},
    "KHR_materials_volume_scatter": {"multiscatterColor": [1, 0, 0]},
    "KHR_materials_clearcoat": {"clearcoatFactor": 1},
    "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 1]},
    "KHR_materials_anisotropy": {"anisotropyStrength": 1},
    "KHR_materials_iridescence": {"iridescenceFactor": 1},
    "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1}}})");
  EXPECT_EQ(m.emissive, Vec3(1));
  EXPECT_EQ(m.ior, 1.5F);
  EXPECT_EQ(m.dispersion, 0);
  EXPECT_EQ(m.specular.value().factor, 1);
  EXPECT_EQ(m.specular.value().color, Vec3(1));
  EXPECT_EQ(m.volume.value().attenuation_distance, std::numeric_limits<float>::infinity());
  EXPECT_EQ(m.volume.value().attenuation_color, Vec3(1));
  EXPECT_EQ(m.volume_scatter.value().anisotropy, 0);
  EXPECT_EQ(m.clearcoat.value().roughness, 0);
  EXPECT_EQ(m.clearcoat.value().normal_scale, 1);
  EXPECT_EQ(m.sheen.value().roughness, 0);
  EXPECT_EQ(m.anisotropy.value().rotation, 0);
  EXPECT_EQ(m.iridescence.value().ior, 1.3F);
  EXPECT_EQ(m.iridescence.value().thickness_minimum, 100);
  EXPECT_EQ(m.iridescence.value().thickness_maximum, 400);
  EXPECT_EQ(m.diffuse_transmission.value().color, Vec3(1));
  EXPECT_FALSE(m.iridescence.value().thickness_texture || m.sheen.value().color_texture);
}

TEST(GltfMaterial, ExtensionsWithoutEffectAreLeftOut) {
  const Material m = material(R"({"extensions": {
    "KHR_materials_transmission": {"transmissionTexture": {"index": 0}},
    "KHR_materials_volume": {"attenuationDistance": 1, "thicknessTexture": {"index": 0}},
    "KHR_materials_volume_scatter": {"scatterAnisotropy": 0.5},
    "KHR_materials_clearcoat": {"clearcoatRoughnessFactor": 1},
    "KHR_materials_sheen": {"sheenRoughnessFactor": 1},
    "KHR_materials_anisotropy": {"anisotropyTexture": {"index": 0}},
    "KHR_materials_iridescence": {"iridescenceThicknessTexture": {"index": 0}},
    "KHR_materials_diffuse_transmission": {"diffuseTransmissionColorFactor": [1, 0, 0]}}})");
  EXPECT_FALSE(m.transmission || m.volume || m.volume_scatter || m.clearcoat || m.sheen ||
               m.anisotropy || m.iridescence || m.diffuse_transmission);
}

TEST(GltfMaterial, NumbersStayFiniteAndPositive) {
  const Material m = material(R"({"emissiveFactor": [1, 1, 1], "extensions": {
    "KHR_materials_ior": {"ior": 0},
    "KHR_materials_emissive_strength": {"emissiveStrength": 1e300},
    "KHR_materials_anisotropy": {"anisotropyStrength": 1, "anisotropyRotation": 1e300},
    "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1e-300}}})");
  EXPECT_EQ(m.ior, 0) << "infinite";
  EXPECT_EQ(m.emissive.x, std::numeric_limits<float>::max());
  EXPECT_EQ(m.volume.value().attenuation_distance, std::numeric_limits<float>::min());
  EXPECT_LT(m.anisotropy.value().rotation, 6.2832F);
}

TEST(GltfMaterial, SpecularGlossinessReplacesMetallicRoughness) {
  constexpr const char* kArchived = R"({
    "extensions": {"KHR_materials_pbrSpecularGlossiness": {
      "diffuseFactor": [0, 0.5, 1, 0.25], "diffuseTexture": {"index": 0},
      "specularFactor": [0.5, 0.25, 0], "glossinessFactor": 0.75,
      "specularGlossinessTexture": {"index": 1}}}})";
  const Material m = material(kArchived);
  EXPECT_EQ(m.base_color, Vec4(0, 0.5F, 1, 0.25F));
  EXPECT_EQ(index_of(m.base_color_texture), 0U);
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.roughness, 0.25F);
  EXPECT_EQ(m.specular_glossiness.value().specular, Vec3(0.5F, 0.25F, 0));
  EXPECT_EQ(m.specular_glossiness.value().glossiness, 0.75F);
  EXPECT_EQ(index_of(m.specular_glossiness.value().texture), 1U);
  AssetBuilder both = with_material(kArchived);
  for (const char* other :
       {"{}", R"({"baseColorFactor": [1, 0, 0, 1], "baseColorTexture": {"index": 3},
                  "metallicFactor": 1, "metallicRoughnessTexture": {"index": 2}})"}) {
    both.json["materials"][0]["pbrMetallicRoughness"] = Json::parse(other);
    for (const SurfaceDetail detail : {SurfaceDetail::color, SurfaceDetail::all}) {
      const Material own = load(both, {.detail = detail}).scene.materials.at(0);
      EXPECT_EQ(own.base_color, m.base_color);
      EXPECT_EQ(index_of(own.base_color_texture), 0U);
      EXPECT_EQ(own.metallic, 0);
      EXPECT_EQ(own.roughness, 0.25F);
      EXPECT_FALSE(own.metallic_roughness_texture);
      EXPECT_EQ(own.specular_glossiness.value().specular, m.specular_glossiness->specular);
    }
  }
  // The extension's omitted properties have their own defaults, not the core material's values.
  Json& own = both.json["materials"][0]["extensions"];
  own["KHR_materials_pbrSpecularGlossiness"] = Json::object();
  EXPECT_EQ(load(both).scene.materials.at(0).base_color, Vec4(1));
  EXPECT_FALSE(load(both).scene.materials.at(0).base_color_texture);
}

TEST(GltfMaterial, UnlitMaterialsShowOnlyTheirBaseColor) {
  const Material m = material(R"({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
                                  "extensions": {"KHR_materials_unlit": {}}})");
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.emissive, Vec3(0));
  EXPECT_FALSE(m.emissive_texture);
}

TEST(GltfMaterial, EachTextureIsVisitedOnceWithItsEncoding) {
  Material m = material(kEverything);
  m.specular_glossiness.emplace().texture = TextureUse{.texture = 19};
  std::vector<int> encodings(20, -1);
  for_each_texture(std::as_const(m), [&](const TextureUse& use, ColorEncoding encoding) {
    EXPECT_EQ(encodings.at(use.texture), -1);
    encodings.at(use.texture) = encoding == ColorEncoding::srgb ? 1 : 0;
  });
  EXPECT_THAT(encodings, ElementsAre(1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 1));
}

// Returns the indices of the images that are decoded for pictures with this detail.
std::vector<std::size_t> decoded(const AssetBuilder& asset, SurfaceDetail detail) {
  const Scene scene = load(asset, {.detail = detail}).scene;
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    if (scene.images[i] != nullptr) result.push_back(i);
  return result;
}

TEST(GltfMaterial, OnlyImagesThatThePictureReadsAreDecoded) {
  AssetBuilder asset = with_material(kEverything);
  EXPECT_THAT(decoded(asset, SurfaceDetail::shape), IsEmpty());
  EXPECT_THAT(decoded(asset, SurfaceDetail::color), ElementsAre(0));
  EXPECT_THAT(decoded(asset, SurfaceDetail::shape_and_color), ElementsAre(0));
  // Contains all textures except occlusion (3) and thickness (8).
  EXPECT_THAT(decoded(asset, SurfaceDetail::all),
              ElementsAre(0, 1, 2, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18));
  asset.json["materials"][0]["alphaMode"] = "MASK";
  EXPECT_THAT(decoded(asset, SurfaceDetail::shape), ElementsAre(0));
  asset.json["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
  asset.json["extensionsUsed"].push_back("KHR_materials_unlit");
  EXPECT_THAT(decoded(asset, SurfaceDetail::all), ElementsAre(0));
}

TEST(GltfMaterial, AnImageWithSeveralUsesIsDecodedIfOneIsRead) {
  AssetBuilder asset = with_material(kEverything);
  asset.json["materials"][0]["occlusionTexture"]["index"] = 1;  // the metallic-roughness texture
  EXPECT_THAT(decoded(asset, SurfaceDetail::all), testing::Contains(1));
}

// If no shader reads an image, only its header is examined.
TEST(GltfMaterial, DamagedPixelsThatNothingReadsAreNoError) {
  AssetBuilder asset = with_material(kEverything);
  std::string png = png_of(1, 1, {9, 8, 7, 6});
  png.resize(png.size() - 20);  // cuts into the pixels
  png += std::string(20, '\xFF');
  const Json damaged = {{"mimeType", "image/png"}, {"bufferView", asset.add_view(png)}};
  for (const std::size_t texture : {3U, 8U, 1U}) {
    AssetBuilder broken = asset;
    broken.json["images"][texture] = damaged;
    const std::vector<std::string> warnings = texts(load(broken).warnings);
    if (texture == 1)
      EXPECT_THAT(warnings, ElementsAre(HasSubstr("can't be decoded")));
    else
      EXPECT_THAT(warnings, IsEmpty()) << texture;
  }
}

TEST(GltfMaterial, MergedScenesKeepTheirTextures) {
  const Scene part = load(with_material(kEverything)).scene;
  Scene whole = part;
  merge(whole, Scene(part));
  const auto shifted = [&](const Material& m) {
    std::vector<std::uint32_t> result;
    for_each_texture(m,
                     [&](const TextureUse& use, ColorEncoding) { result.push_back(use.texture); });
    return result;
  };
  std::vector<std::uint32_t> wanted = shifted(part.materials.at(0));
  ASSERT_EQ(wanted.size(), 19U);
  for (std::uint32_t& texture : wanted) texture += 24;
  EXPECT_EQ(shifted(whole.materials.at(part.materials.size())), wanted);
}

TEST(GltfMaterial, NumbersOutOfRangeAreClamped) {
  const AssetBuilder asset = with_material(R"({
    "pbrMetallicRoughness": {"baseColorFactor": [1.00000012, -1, 1e300, 0.5],
                             "metallicFactor": -0.1, "roughnessFactor": 1.1},
    "emissiveFactor": [2, 0.5, -1], "alphaCutoff": -3,
    "occlusionTexture": {"index": 0, "strength": 1.5, "texCoord": -1},
    "extensions": {
      "KHR_materials_emissive_strength": {"emissiveStrength": -1},
      "KHR_materials_ior": {"ior": 0.5},
      "KHR_materials_dispersion": {"dispersion": -1},
      "KHR_materials_specular": {"specularFactor": 1.5, "specularColorFactor": [7, -1, 1]},
      "KHR_materials_transmission": {"transmissionFactor": 2},
      "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0,
                               "attenuationColor": [2, 1, 0]},
      "KHR_materials_volume_scatter": {"multiscatterColor": [1, 2, 0], "scatterAnisotropy": -2},
      "KHR_materials_clearcoat": {"clearcoatFactor": 2, "clearcoatRoughnessFactor": -1},
      "KHR_materials_sheen": {"sheenColorFactor": [2, 0, 0], "sheenRoughnessFactor": 3},
      "KHR_materials_anisotropy": {"anisotropyStrength": 1.1},
      "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 0.9,
                                    "iridescenceThicknessMaximum": -1},
      "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 2}}})");
  const LoadedScene loaded = load(asset);
  const Material& m = loaded.scene.materials.at(0);
  EXPECT_EQ(m.base_color, Vec4(1, 0, 1, 0.5F));
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.emissive, Vec3(0));
  EXPECT_EQ(m.alpha_cutoff, 0);
  EXPECT_EQ(m.occlusion_strength, 1);
  EXPECT_EQ(m.occlusion_texture.value().uv_set, 0U);
  EXPECT_EQ(m.ior, 1);
  EXPECT_EQ(m.dispersion, 0);
  EXPECT_EQ(m.specular.value().factor, 1);
  EXPECT_EQ(m.specular.value().color, Vec3(7, 0, 1));
  EXPECT_EQ(m.transmission.value().factor, 1);
  EXPECT_EQ(m.volume.value().attenuation_distance, Volume().attenuation_distance);
  EXPECT_EQ(m.volume.value().attenuation_color, Vec3(1, 1, 0));
  EXPECT_EQ(m.volume_scatter.value().multiscatter_color, Vec3(1, 1, 0));
  EXPECT_EQ(m.volume_scatter.value().anisotropy, -1);
  EXPECT_EQ(m.clearcoat.value().factor, 1);
  EXPECT_EQ(m.clearcoat.value().roughness, 0);
  EXPECT_EQ(m.sheen.value().color, Vec3(1, 0, 0));
  EXPECT_EQ(m.sheen.value().roughness, 1);
  EXPECT_EQ(m.anisotropy.value().strength, 1);
  EXPECT_EQ(m.iridescence.value().ior, 1);
  EXPECT_EQ(m.iridescence.value().thickness_maximum, 0);
  EXPECT_EQ(m.diffuse_transmission.value().factor, 1);
  std::size_t errors = 0;
  for (const Diagnostic& warning : loaded.warnings) {
    if (warning.severity == Severity::error && warning.pointer.starts_with("/materials/0/"))
      ++errors;
  }
  EXPECT_EQ(errors, 15U);  // each message is reported once
  EXPECT_EQ(material(R"({"extensions": {"KHR_materials_ior": {"ior": -1}}})").ior, 1.5F);
}

TEST(GltfMaterial, WrongTypesAndLengthsAreRefused) {
  struct Case {
    const char* extension;
    const char* properties;
    const char* pointer;
  };
  for (const Case& c : {
           Case{"volume", R"({"attenuationColor": [1, 1]})", "attenuationColor"},
           Case{"volume_scatter", R"({"multiscatterColor": [1, 1]})", "multiscatterColor"},
           Case{"volume_scatter", R"({"scatterAnisotropy": [0.5]})", "scatterAnisotropy"},
           Case{"clearcoat", R"({"clearcoatNormalTexture": {"index": 99}})",
                "clearcoatNormalTexture/index"},
           Case{"sheen", R"({"sheenRoughnessFactor": "1"})", "sheenRoughnessFactor"},
           Case{"pbrSpecularGlossiness", R"({"diffuseFactor": [1, 1, 1]})", "diffuseFactor"},
       }) {
    const std::string name = std::string("KHR_materials_") + c.extension;
    const std::string json = R"({"extensions": {")" + name + "\": " + c.properties + "}}";
    try {
      (void)material(json.c_str());
      ADD_FAILURE() << json << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
      EXPECT_EQ(error.diagnostic().pointer, "/materials/0/extensions/" + name + "/" + c.pointer);
    }
  }
}

}  // namespace
}  // namespace microtrace::tests
