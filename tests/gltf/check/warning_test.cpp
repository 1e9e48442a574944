#include "gltf/asset_builder.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Ignored {
  const char* add;  ///< a JSON merge patch (RFC 7396) for the cube
  const char* pointer;
  const char* message;
};

TEST(GltfWarning, EachIgnoredFeatureIsNamedWithItsFirstPointer) {
  const Ignored cases[] = {
      {R"({"extensionsUsed": ["KHR_materials_unlit", "EXT_made_up"]})", "/extensionsUsed/1",
       "EXT_made_up"},
      {R"({"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
           "textures": [{}]})",
       "/textures/0", "no image"},
      {R"({"materials": [{"emissiveFactor": [0, 0, 1]}]})", "/materials/0/emissiveFactor",
       "emission"},
      {R"({"meshs": []})", "/meshs", "is not a glTF 2.0 property"},
      {R"({"cameras": []})", "/cameras", "empty"},
  };
  for (const Ignored& c : cases) {
    SCOPED_TRACE(c.add);
    AssetBuilder asset = cube();
    asset.add("accessors", {{"componentType", kFloat32}, {"count", 8}, {"type", "SCALAR"}});
    asset.json.merge_patch(Json::parse(c.add));
    EXPECT_THAT(
        texts(load(asset, {.detail = SurfaceDetail::color}).warnings),
        testing::Contains(AllOf(HasSubstr(std::string(c.pointer) + ": "), HasSubstr(c.message))));
  }
}

TEST(GltfWarning, SupportedFeaturesGiveNone) {
  AssetBuilder asset = cube();
  asset.json.merge_patch(Json::parse(
      R"({"extensionsUsed": ["KHR_materials_unlit"], "extensionsRequired": ["KHR_materials_unlit"],
          "extras": {"anything": [null]},
          "materials": [{"name": "m", "extensions": {"KHR_materials_unlit": {}},
                         "alphaMode": "BLEND", "doubleSided": true,
                         "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5}}]})"));
  EXPECT_THAT(texts(load(asset).warnings), IsEmpty());
}

// JSON's -0 and -0.0 are the integer 0.
TEST(GltfWarning, MinusZeroIsZero) {
  AssetBuilder asset = cube();
  asset.json["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0.25}}}}};
  asset.json["meshes"][0]["primitives"][0]["material"] = -0.0;
  for (const char* array : {"accessors", "bufferViews"}) {
    for (Json& item : asset.json[array]) {
      for (const char* key : {"bufferView", "buffer", "byteOffset"})
        if (item.contains(key) && item[key] == 0) item[key] = -0.0;
    }
  }
  asset.json["scenes"][0]["nodes"][0] = -0.0;
  const LoadedScene loaded = load(asset);
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
  ASSERT_EQ(loaded.scene.objects.size(), 1U);
  EXPECT_EQ(loaded.scene.objects[0].material, 0U);
}

TEST(GltfWarning, MatricesOfSmallNumbersHavePaddedColumns) {
  AssetBuilder asset = cube();
  const std::size_t accessor = asset.add_accessor("MAT3", std::string(8 * 12, '\1'), kUint8, false);
  asset.json["accessors"][accessor]["count"] = 8;
  asset.json["meshes"][0]["primitives"][0]["attributes"]["_M"] = accessor;
  EXPECT_THAT(texts(load(asset).warnings), IsEmpty());
}

TEST(GltfWarning, TexturesOfUnknownExtensionsNeedNoCoordinates) {
  AssetBuilder asset = cube();
  asset.json["extensionsUsed"] = {"X_toon"};
  asset.json["materials"] = Json::parse(
      R"([{"extensions": {"X_toon": {"matcapTexture": {"index": 99, "texCoord": 3}}}}])");
  asset.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_THAT(texts(load(asset).warnings), ElementsAre(HasSubstr("/extensionsUsed/0")));
}

TEST(GltfWarning, TextureCoordinatesBeyondTheLimitAreNamed) {
  AssetBuilder asset = cube();
  Json& primitive = asset.json["meshes"][0]["primitives"][0];
  for (int set = 0; set <= 16; ++set)
    primitive["attributes"]["TEXCOORD_" + std::to_string(set)] =
        asset.add_numbers("VEC2", std::vector<float>(16, 0.5F));
  primitive["material"] = 0;
  asset.json["textures"] = Json::array({Json::object()});
  asset.json["materials"] = {
      {{"emissiveTexture", {{"index", 0}, {"texCoord", 16}}}, {"emissiveFactor", {1, 1, 1}}}};
  EXPECT_THAT(texts(load(asset, {.detail = SurfaceDetail::all}).warnings),
              testing::Contains(HasSubstr("needs TEXCOORD_16")));
}

TEST(GltfWarning, EqualWarningsBecomeOneWithACount) {
  AssetBuilder asset = cube();
  const Json shining = {{"emissiveFactor", {0, 0, 1}}};
  asset.json["materials"] = {Json::object(), shining, shining, shining};
  EXPECT_THAT(
      texts(load(asset, {.detail = SurfaceDetail::color}).warnings),
      ElementsAre(AllOf(HasSubstr("/materials/1/emissiveFactor"), HasSubstr("(3 places)"))));
}

TEST(GltfWarning, WarningsAreInFileOrderAndLimited) {
  AssetBuilder asset = cube();
  for (int i = 0; i < 5000; ++i) {
    asset.json["extensionsUsed"].push_back("X_" + std::to_string(i));
  }
  const LoadedScene loaded = load(asset);
  ASSERT_EQ(loaded.warnings.size(), 101U);
  EXPECT_EQ(loaded.warnings[99].pointer, "/extensionsUsed/99");
  EXPECT_THAT(loaded.warnings[100].message, HasSubstr("4900 more warnings"));
  for (std::size_t i = 1; i < 100; ++i) {
    EXPECT_GT(loaded.warnings[i].line, loaded.warnings[i - 1].line);
  }
}

TEST(GltfWarning, DistinguishesViolationsFromOtherWarnings) {
  AssetBuilder asset = cube();
  asset.json["extensionsUsed"] = {"X_unknown"};
  asset.json["materials"][0]["alphaCutoff"] = -1;
  const std::vector<Diagnostic> found = load(asset).warnings;
  ASSERT_EQ(found.size(), 2U);
  for (const Diagnostic& d : found) {
    EXPECT_EQ(d.severity, d.pointer == "/extensionsUsed/0" ? Severity::warning : Severity::error);
  }
  // Even if the list of unknown extensions is cut short, the asset must not be reported as valid.
  for (int i = 0; i < 100; ++i) asset.json["extensionsUsed"].push_back("X_" + std::to_string(i));
  EXPECT_EQ(load(asset).warnings.back().severity, Severity::error);
  asset.json["materials"][0].erase("alphaCutoff");
  EXPECT_EQ(load(asset).warnings.back().severity, Severity::warning);
}

TEST(GltfWarning, PrimitivesWithoutBufferDataAreNotDrawn) {
  const LoadedScene loaded = load(cube().with_buffer(nullptr).dump());
  EXPECT_THAT(loaded.scene.objects, IsEmpty());
  EXPECT_THAT(texts(loaded.warnings),
              testing::UnorderedElementsAre(
                  HasSubstr("nothing to draw"), HasSubstr("/buffers/0: has no uri"),
                  HasSubstr("/meshes/0/primitives/0: needs data that is not there")));
}

}  // namespace
}  // namespace microtrace::tests
