#include "gltf/asset_builder.hpp"
#include "support/png_file.hpp"
#include "support/source_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::NotNull;
using testing::ThrowsMessage;

std::string ktx2_file(const std::string& name) {
  const auto path = source_folder() / "tests/image/ktx2" / (name + ".ktx2");
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns the cube with a texture whose source is image 0 (KTX2). Image 1 (PNG) is the fallback.
AssetBuilder textured(const std::string& ktx2) {
  AssetBuilder asset = cube();
  asset.json["extensionsUsed"] = {"KHR_texture_basisu"};
  asset.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.add("accessors", {{"componentType", kFloat32}, {"count", 8}, {"type", "VEC2"}});
  asset.add("textures", {{"source", 1}, {"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
  asset.add("images", {{"mimeType", "image/ktx2"}, {"bufferView", asset.add_view(ktx2)}});
  asset.add("images", {{"mimeType", "image/png"},
                       {"bufferView", asset.add_view(png_of(1, 1, {9, 8, 7, 6}))}});
  return asset;
}

/// The only image that was decoded.
const Image& image_of(const Scene& scene) {
  const Texture& texture = scene.textures.at(0);
  EXPECT_EQ(texture.image, 0U);
  EXPECT_THAT(scene.images.at(0), NotNull());
  return *scene.images.at(0);
}

TEST(GltfBasisu, Ktx2IsPreferredToItsFallbackAndMayBeRequired) {
  AssetBuilder asset = textured(ktx2_file("etc1s_runs_100x36"));
  asset.json["extensionsRequired"] = {"KHR_texture_basisu"};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
  EXPECT_EQ(image_of(loaded.scene).width, 100U);
  EXPECT_EQ(image_of(loaded.scene).height, 36U);
  EXPECT_EQ(image_of(loaded.scene).channels, 4U);
  const LoadedScene glb = load(asset.glb());
  EXPECT_EQ(image_of(glb.scene).samples, image_of(loaded.scene).samples);
  asset.json["images"][0] = {
      {"uri", "data:image/ktx2;base64," + base64(ktx2_file("etc1s_runs_100x36"))}};
  EXPECT_EQ(image_of(load(asset).scene).samples, image_of(loaded.scene).samples);
}

TEST(GltfBasisu, TheMaterialDeterminesTheColorEncoding) {
  AssetBuilder color = textured(ktx2_file("uastc_linear_4x4"));
  EXPECT_THAT(texts(load(color).warnings),
              ElementsAre(HasSubstr("/images/0: declares its values linear, but materials "
                                    "use them as sRGB")));
  AssetBuilder normal = textured(ktx2_file("etc1s_runs_100x36"));
  Json& material = normal.json["materials"][0];
  material["normalTexture"] = material["pbrMetallicRoughness"]["baseColorTexture"];
  EXPECT_THAT(texts(load(normal).warnings), IsEmpty()) << "it is both";
  material["pbrMetallicRoughness"].erase("baseColorTexture");
  EXPECT_THAT(texts(load(normal).warnings),
              ElementsAre(HasSubstr("values sRGB, but materials use them as linear")));
  material.erase("normalTexture");
  EXPECT_THAT(texts(load(normal).warnings), IsEmpty()) << "nobody looks";

  std::string premultiplied = ktx2_file("etc1s_runs_100x36");
  premultiplied[static_cast<unsigned char>(premultiplied[48]) + 15] = 1;
  EXPECT_THAT(texts(load(textured(premultiplied)).warnings),
              ElementsAre(HasSubstr("premultiplied alpha")));
}

TEST(GltfBasisu, SidesShouldBeMultiplesOfFour) {
  const LoadedScene loaded = load(textured(ktx2_file("etc1s_3x5")));
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("/images/0: has sides that are no")));
  EXPECT_EQ(image_of(loaded.scene).height, 5U);
}

/// Returns the cube with a texture that has only a KTX2 image.
AssetBuilder without_fallback(const std::string& ktx2) {
  AssetBuilder asset = textured(ktx2);
  asset.json["textures"][0].erase("source");
  return asset;
}

TEST(GltfBasisu, DamagedAndUnsupportedTexturesAreWhite) {
  const auto expect = [](const std::string& ktx2, const char* words) {
    const LoadedScene loaded = load(without_fallback(ktx2));
    EXPECT_THAT(texts(loaded.warnings),
                Contains(AllOf(HasSubstr("/images/0: can't be decoded, so its textures are white"),
                               HasSubstr(words))));
    EXPECT_EQ(loaded.scene.images.at(0), nullptr);
  };
  std::string ktx2 = ktx2_file("etc1s_runs_100x36");
  expect(ktx2.substr(0, 500), "the base level is cut off");
  ktx2[36] = 6;
  expect(ktx2, "is KTX2 with 6 faces");
  ktx2[20] = 0;
  try {
    (void)load(without_fallback(ktx2));
    ADD_FAILURE() << "has no size";
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostic().pointer, "/images/0");
    EXPECT_THAT(error.what(), HasSubstr("header has no size"));
  }
}

TEST(GltfBasisu, FallbacksReplaceTexturesThatCannotBeDecoded) {
  const std::string ktx2 = ktx2_file("etc1s_runs_100x36");
  std::string no_size = ktx2;
  no_size[20] = 0;
  const std::string damaged[] = {ktx2.substr(0, 500), no_size, "neither PNG nor KTX2"};
  for (const std::string& bytes : damaged) {
    const LoadedScene loaded = load(textured(bytes));
    EXPECT_THAT(
        texts(loaded.warnings),
        ElementsAre(AllOf(HasSubstr("/images/0: "), HasSubstr("its textures use other images"))));
    EXPECT_EQ(loaded.scene.textures.at(0).image, 1U);
    ASSERT_THAT(loaded.scene.images.at(1), NotNull());
    EXPECT_EQ(loaded.scene.images[1]->width, 1U);
  }
  // A texture without a fallback keeps its image, which is null.
  AssetBuilder both = textured(ktx2.substr(0, 500));
  both.add("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
  const LoadedScene loaded = load(both);
  EXPECT_THAT(texts(loaded.warnings),
              ElementsAre(HasSubstr("its textures without another image are white")));
  EXPECT_EQ(loaded.scene.textures.at(0).image, 1U);
  EXPECT_EQ(loaded.scene.textures.at(1).image, 0U);
}

TEST(GltfBasisu, FallbacksThatAreNotNeededMayBeUnreadable) {
  const std::string png = png_of(1, 1, {9, 8, 7, 6});
  AssetBuilder asset = textured(ktx2_file("etc1s_runs_100x36"));
  const auto fallback = [&asset](const std::string& bytes) -> Json {
    return {{"mimeType", "image/png"}, {"bufferView", asset.add_view(bytes)}};
  };
  const Json unreadable[] = {{{"uri", "none.png"}},
                             fallback(png.substr(0, 20)),
                             fallback(png.substr(0, 8) + png)};  // has a damaged header
  for (const Json& image : unreadable) {
    asset.json["images"][1] = image;
    const LoadedScene loaded = load(asset);
    EXPECT_THAT(texts(loaded.warnings),
                ElementsAre(AllOf(HasSubstr("/images/1"), HasSubstr("; it is not used"))));
    EXPECT_EQ(image_of(loaded.scene).width, 100U);
  }
  asset.add("textures", {{"source", 1}});
  EXPECT_THAT([&] { (void)load(asset); }, ThrowsMessage<Error>(HasSubstr("header has no size")))
      << "has no other image";
}

TEST(GltfBasisu, TexturesAreWhiteIfTheirFallbackCannotBeReadEither) {
  AssetBuilder asset = textured(ktx2_file("etc1s_runs_100x36").substr(0, 500));
  asset.json["images"][1] = {{"uri", "none.png"}};
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("so its textures are white: "),
                                                  HasSubstr("; its textures are white")));
}

TEST(GltfBasisu, ImagesThatCannotBeDecodedDoNotCountTowardTheLimitOfPixels) {
  std::string ktx2 = ktx2_file("etc1s_runs_100x36");
  for (const std::size_t side : {20U, 24U}) ktx2.replace(side, 4, {'\0', '\x40', '\0', '\0'});
  const LoadedScene loaded = load(textured(ktx2));  // 2^14 x 2^14 pixels, the limit
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("/images/0: can't be decoded")));
  EXPECT_EQ(loaded.scene.textures.at(0).image, 1U);
  EXPECT_THAT(loaded.scene.images.at(1), NotNull());
}

}  // namespace
}  // namespace microtrace::tests
