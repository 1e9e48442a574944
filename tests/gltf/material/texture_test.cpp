#include "gltf/asset_builder.hpp"
#include "support/png_file.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::NotNull;

/// Returns the cube with one texture on its material, and an image of one pixel.
AssetBuilder textured() {
  AssetBuilder asset = cube();
  asset.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  const std::size_t uv =
      asset.add("accessors", {{"componentType", kFloat32}, {"count", 8}, {"type", "VEC2"}});
  for (const char* set : {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"}) {
    asset.json["meshes"][0]["primitives"][0]["attributes"][set] = uv;
  }
  asset.add("textures", {{"source", 0}});
  asset.add("images", {{"mimeType", "image/png"},
                       {"bufferView", asset.add_view(png_of(1, 1, {9, 8, 7, 6}))}});
  return asset;
}

void expect_pixel(const LoadedScene& loaded) {
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
  const Scene& scene = loaded.scene;
  const Material& material = material_of(scene, scene.objects.at(0));
  ASSERT_TRUE(material.base_color_texture);
  const Texture& texture = scene.textures.at(material.base_color_texture->texture);
  ASSERT_TRUE(texture.image);
  const auto& image = scene.images.at(*texture.image);
  ASSERT_THAT(image, NotNull());
  EXPECT_THAT(std::get<std::vector<std::uint8_t>>(image->samples), ElementsAre(9, 8, 7, 6));
}

Error error_of(const AssetBuilder& asset) {
  try {
    (void)load(asset);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "was read";
  return {ErrorKind::internal, "", ""};
}

TEST(GltfTexture, ImagesMayBeInBufferViewsDataUrisAndFiles) {
  AssetBuilder asset = textured();
  expect_pixel(load(asset.embedded()));
  expect_pixel(load(asset.glb()));
  const std::string png = png_of(1, 1, {9, 8, 7, 6});
  asset.json["images"][0] = {{"uri", "data:image/png;base64," + base64(png)}};
  expect_pixel(load(asset));

  const auto folder = std::filesystem::temp_directory_path() / "microtrace_texture_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a b.png", std::ios::binary) << png;
  asset.json["images"][0] = {{"uri", "a%20b.png"}};
  expect_pixel(parse_scene(asset.embedded(), "test.gltf", folder));
  std::filesystem::remove_all(folder);
}

TEST(GltfTexture, MissingFilesAreWhite) {
  AssetBuilder asset = textured();
  asset.json["images"][0] = {{"uri", "none.png"}};
  for (const char* drawn : {"drawn", "not drawn"}) {
    SCOPED_TRACE(drawn);
    const LoadedScene loaded = load(asset);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_EQ(loaded.warnings[0].pointer, "/images/0/uri");
    EXPECT_THAT(loaded.warnings[0].message, HasSubstr("does not exist"));
    EXPECT_EQ(loaded.scene.images.at(0), nullptr);
    asset.json["materials"] = Json::array({Json::object()});
  }
}

TEST(GltfTexture, FilesThatMayNotBeReadAreWhite) {
  for (const auto& [uri, reason] : {std::pair{"../a.png", "leaves the asset's folder"},
                                    {"/a.png", "is absolute"},
                                    {"https://example.org/a.png", "has a scheme"},
                                    {"C:\\a.png", "absolute path of Windows"}}) {
    AssetBuilder asset = textured();
    asset.json["images"] = {{{"uri", uri}}};
    const LoadedScene loaded = load(asset);
    EXPECT_THAT(texts(loaded.warnings),
                Contains(testing::AllOf(HasSubstr("/images/0/uri: "), HasSubstr(reason),
                                        HasSubstr("textures are white"))));
    EXPECT_EQ(loaded.scene.images.at(0), nullptr);
  }
}

TEST(GltfTexture, DamagedImagesAreWhite) {
  AssetBuilder asset = textured();
  const std::string png = png_of(1, 1, {9, 8, 7, 6});
  asset.json["images"][0]["bufferView"] = asset.add_view(png.substr(0, 50));
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings),
              Contains(HasSubstr("/images/0: can't be decoded, so its textures are white: the file "
                                 "is cut off")));
  EXPECT_EQ(loaded.scene.images.at(0), nullptr);
  asset.json["images"][0]["bufferView"] = asset.add_view(png.substr(0, 8) + png);
  EXPECT_THAT(error_of(asset).what(), HasSubstr("header"));
}

TEST(GltfTexture, TruncatedHeadersGiveWhiteTexturesWithAWarning) {
  AssetBuilder asset = textured();
  const std::string png = png_of(1, 1, {9, 8, 7, 6});
  asset.json["images"][0]["bufferView"] = asset.add_view(png.substr(0, 20));
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings),
              ElementsAre(HasSubstr("/images/0: holds an image that is truncated")));
  EXPECT_EQ(loaded.scene.images.at(0), nullptr);
}

TEST(GltfTexture, OversizedImagesAreRefusedBeforeAllocation) {
  AssetBuilder asset = textured();
  const std::string png = png_file({.width = 1U << 20U, .height = 1U << 20U});
  asset.json["images"][0]["bufferView"] = asset.add_view(png);
  EXPECT_EQ(error_of(asset).kind(), ErrorKind::limit);
  EXPECT_EQ(error_of(asset).diagnostic().pointer, "/images/0");
}

TEST(GltfTexture, UnsupportedFormatsGiveWhiteTexturesWithAWarning) {
  AssetBuilder asset = textured();
  asset.json["images"][0] = {{"uri", "data:image/avif;base64," + base64("ftypavif")}};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("/images/0: is neither PNG")));
  EXPECT_EQ(loaded.scene.images.at(0), nullptr);
}

TEST(GltfTexture, AWrongMediaTypeIsAWarning) {
  AssetBuilder asset = textured();
  asset.json["images"][0]["mimeType"] = "image/jpeg";
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("image/png")));
  EXPECT_THAT(loaded.scene.images.at(0), NotNull());
}

TEST(GltfTexture, DataUrisMustDeclareTheirMediaType) {
  AssetBuilder asset = textured();
  const std::string png = base64(png_of(1, 1, {9, 8, 7, 6}));
  for (const char* type :
       {"", "image/gif", "image/jpeg", "image/jpg", "application/octet-stream"}) {
    asset.json["images"][0] = {{"uri", std::string("data:") + type + ";base64," + png}};
    for (const bool has_type : {false, true}) {
      if (has_type) asset.json["images"][0]["mimeType"] = "image/png";
      const LoadedScene loaded = load(asset);
      EXPECT_THAT(loaded.scene.images.at(0), NotNull()) << type;
      ASSERT_EQ(loaded.warnings.size(), 1U) << type;
      EXPECT_EQ(loaded.warnings[0].severity, Severity::error) << type;
      EXPECT_EQ(loaded.warnings[0].pointer, "/images/0/uri") << type;
      EXPECT_THAT(loaded.warnings[0].message, HasSubstr("is image/png")) << type;
    }
  }
  asset.json["images"][0] = {{"uri", "data:image/png;base64,AAAA"}};
  EXPECT_EQ(load(asset).scene.images.at(0), nullptr);
  EXPECT_THAT(texts(load(asset).warnings),
              testing::Contains(HasSubstr("/images/0/uri: has the media type")));
  asset.json["images"][0] = {{"uri", "data:Image/PNG;base64," + png}};
  EXPECT_THAT(load(asset).scene.images.at(0), NotNull());
  EXPECT_THAT(texts(load(asset).warnings), testing::IsEmpty());
}

TEST(GltfTexture, OnlyVisibleImagesAreDecoded) {
  AssetBuilder asset = textured();
  asset.json["materials"][0]["normalTexture"] = {{"index", 1}};
  asset.add("textures", {{"source", 1}});
  asset.add("images", asset.json["images"][0]);
  const LoadedScene flat =
      parse_scene(asset.embedded(), "test.gltf", "", {.detail = SurfaceDetail::color});
  EXPECT_THAT(flat.scene.images.at(0), NotNull());
  EXPECT_EQ(flat.scene.images.at(1), nullptr);
  EXPECT_THAT(load(asset).scene.images.at(1), NotNull());
}

TEST(GltfTexture, WebpIsPreferredToItsFallback) {
  AssetBuilder asset = textured();
  asset.json["extensionsUsed"] = {"EXT_texture_webp"};
  asset.add("images", {{"uri",
                        "data:image/webp;base64,UklGRkIAAABXRUJQVlA4TDUAAAAvAUAAEB8gpiHMp39ePc"
                        "SkCfjZP/AUtG3D9I8/4EkCAcK6M2cC2MzevqCmbQMWv0lHRP+DAwA="}});
  asset.json["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 1}};
  EXPECT_EQ(load(asset).scene.textures.at(0).image, 1U);
  EXPECT_THAT(texts(load(asset).warnings), IsEmpty());
  asset.json["extensionsUsed"] = {"EXT_texture_avif"};
  asset.json["textures"][0] = {{"extensions", {{"EXT_texture_avif", {{"source", 0}}}}}};
  const LoadedScene loaded = load(asset);
  EXPECT_EQ(loaded.scene.textures.at(0).image, std::nullopt);
  EXPECT_THAT(texts(loaded.warnings), testing::Contains(HasSubstr("it is white")));
  asset.json["extensionsRequired"] = {"EXT_texture_avif"};
  EXPECT_EQ(error_of(asset).kind(), ErrorKind::unsupported);
}

TEST(GltfTexture, SamplersAreReadAndHaveDefaults) {
  AssetBuilder asset = textured();
  const Sampler standard = load(asset).scene.textures.at(0).sampler;
  EXPECT_EQ(standard.wrap_s, Wrap::repeat);
  EXPECT_EQ(standard.magnification, Filter::linear);
  EXPECT_EQ(standard.mip, MipFilter::linear);
  struct Case {
    int min_filter;
    Filter filter;
    MipFilter mip;
  };
  asset.json["textures"][0]["sampler"] = 0;
  for (const Case& c : {Case{9728, Filter::nearest, MipFilter::none},
                        {9729, Filter::linear, MipFilter::none},
                        {9984, Filter::nearest, MipFilter::nearest},
                        {9985, Filter::linear, MipFilter::nearest},
                        {9986, Filter::nearest, MipFilter::linear},
                        {9987, Filter::linear, MipFilter::linear}}) {
    asset.json["samplers"] = {
        {{"minFilter", c.min_filter}, {"magFilter", 9728}, {"wrapS", 33648}, {"wrapT", 33071}}};
    const Sampler sampler = load(asset).scene.textures.at(0).sampler;
    EXPECT_EQ(sampler.minification, c.filter) << c.min_filter;
    EXPECT_EQ(sampler.mip, c.mip) << c.min_filter;
    EXPECT_EQ(sampler.magnification, Filter::nearest);
    EXPECT_EQ(sampler.wrap_s, Wrap::mirrored_repeat);
    EXPECT_EQ(sampler.wrap_t, Wrap::clamp_to_edge);
  }
}

TEST(GltfTexture, TransformScalesRotatesAndTranslates) {
  AssetBuilder asset = textured();
  asset.json["extensionsUsed"] = {"KHR_texture_transform"};
  // The specification's example, which shows the lower left quarter of the image, rotated by 90
  // degrees.
  asset.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform",
       {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}, {"texCoord", 3}}}};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
  const TextureUse use = *loaded.scene.materials.at(0).base_color_texture;
  EXPECT_EQ(use.uv_set, 3U);
  const auto at = [&use](const Vec3& uv) { return use.texture_from_uv * uv; };
  const Vec2 origin = at({0, 0, 1}), right = at({1, 0, 1}), down = at({0, 1, 1});
  EXPECT_NEAR(origin.x, 0, 1e-6F);
  EXPECT_NEAR(origin.y, 1, 1e-6F);
  EXPECT_NEAR(right.x, 0, 1e-6F);
  EXPECT_NEAR(right.y, 0.5F, 1e-6F);
  EXPECT_NEAR(down.x, 0.5F, 1e-6F);
  EXPECT_NEAR(down.y, 1, 1e-6F);
}

TEST(GltfTexture, ReadsTheTexturesOfPathTracedMaterials) {
  AssetBuilder asset = textured();
  asset.json["materials"][0] = Json::parse(R"({
    "name": "steel", "alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [0.5, 0, 1],
    "pbrMetallicRoughness": {"metallicFactor": 0.75, "roughnessFactor": 0.125,
                             "metallicRoughnessTexture": {"index": 0, "texCoord": 1}},
    "normalTexture": {"index": 0, "scale": -2}, "occlusionTexture": {"index": 0, "strength": 0.5},
    "emissiveTexture": {"index": 0}})");
  const Scene scene = load(asset).scene;
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.name, "steel");
  EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(material.alpha_cutoff, 0.25F);
  EXPECT_FALSE(material.double_sided);
  EXPECT_EQ(material.metallic, 0.75F);
  EXPECT_EQ(material.roughness, 0.125F);
  EXPECT_EQ(material.metallic_roughness_texture.value().uv_set, 1U);
  EXPECT_EQ(material.normal_scale, -2);
  EXPECT_EQ(material.occlusion_strength, 0.5F);
  EXPECT_EQ(material.emissive, Vec3(0.5F, 0, 1));
  EXPECT_TRUE(material.emissive_texture);
  EXPECT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.materials[1].metallic, 1) << "of primitives without material";
}

TEST(GltfMaterial, VariantsAreSelectedByNameOrIndex) {
  AssetBuilder asset = cube();
  asset.json["extensionsUsed"] = {"KHR_materials_variants"};
  asset.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "plain"}},
                                                                    {{"name", "green"}}};
  const auto green =
      asset.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 1}}}}});
  asset.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", green}, {"variants", {1}}},
      {{"material", 0}, {"variants", {1}}}};  // the first material counts
  const auto color = [&](const std::string& variant) {
    return color_of(parse_scene(asset.embedded(), "test.gltf", "", {.variant = variant}), 0);
  };
  EXPECT_EQ(color(""), Vec4(1, 0.25F, 0.125F, 1));
  EXPECT_EQ(color("plain"), Vec4(1, 0.25F, 0.125F, 1));
  EXPECT_EQ(color("green"), Vec4(0, 1, 0, 1));
  EXPECT_EQ(color("1"), Vec4(0, 1, 0, 1));
  try {
    (void)color("blue");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_THAT(error.what(), HasSubstr("0 (plain), 1 (green)"));
  }
}

}  // namespace
}  // namespace microtrace::tests
