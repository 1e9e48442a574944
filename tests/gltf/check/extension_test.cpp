#include "gltf/asset_builder.hpp"
#include "io/gltf/extensions/extensions.hpp"
#include "io/gltf/material/materials.hpp"
#include "scene/material_textures.hpp"
#include "support/png_file.hpp"
#include "support/source_folder.hpp"

#include <microtrace/framing.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>
#include <set>

#include <gmock/gmock.h>

// The tests report forgotten parts of an extension. The parts are listed in
// io/gltf/extensions/extensions.hpp.

namespace microtrace::tests {
namespace {

using io::gltf::Extension;
using io::gltf::extensions;
using io::gltf::Form;
using io::gltf::Place;
using io::gltf::Rule;
using io::gltf::Support;

std::vector<const Extension*> extensions_of_materials() {
  std::vector<const Extension*> result;
  for (const Extension& extension : extensions()) {
    const bool is_read = extension.read_material != nullptr;
    EXPECT_EQ(is_read, extension.support == Support::full && extension.object_in(Place::material))
        << extension.name;
    if (is_read) result.push_back(&extension);
  }
  return result;
}

std::span<const Rule> rules_of(const Extension& extension) {
  return extension.object_in(Place::material)->rules;
}

std::string name_of(const Extension& extension, const Rule& rule) {
  return std::string(extension.name) + ", " + std::string(rule.key);
}

bool is_texture(const Rule& rule) {
  return rule.place == Place::texture_info;
}

/// Returns a value that is not the default of any property.
Json value_of(const Rule& rule) {
  const double least = std::max(rule.min, -1.0), most = std::min(rule.max, least + 1);
  // Distinct keys get distinct values, at least where a test combines them.
  const int sum = std::accumulate(rule.key.begin(), rule.key.end(), 0);
  const double share = 0.4 + 0.002 * (sum % 97);
  const double number = least + share * (most - least);
  return rule.form == Form::numbers ? Json::repeated(rule.most, number) : Json(number);
}

/// Reads a material that has only this extension, without validation.
Material material_of(const Extension& extension, const Json& object) {
  Json asset;
  asset["materials"][0] = {{"emissiveFactor", {0.5, 0.25, 0.125}},
                           {"extensions", {{std::string(extension.name), object}}}};
  const std::string text = asset.dump();
  const io::JsonDocument document(text, "test.gltf");
  return io::gltf::make_materials(document.root(), io::gltf::UnusedLayers::kept).at(0);
}

TEST(GltfExtensions, AreListedOnceByName) {
  EXPECT_GT(extensions().size(), 25U);
  for (const Extension& extension : extensions()) {
    EXPECT_EQ(io::gltf::find_extension(extension.name), &extension) << extension.name;
  }
  EXPECT_EQ(io::gltf::find_extension("KHR_unheard_of"), nullptr);
}

TEST(GltfExtensions, EachNumberOfMaterialsIsRead) {
  for (const Extension* extension : extensions_of_materials()) {
    const Material standard = material_of(*extension, Json::object());
    for (const Rule& rule : rules_of(*extension)) {
      if (is_texture(rule)) continue;
      const Material changed = material_of(*extension, {{std::string(rule.key), value_of(rule)}});
      EXPECT_FALSE(changed == standard) << name_of(*extension, rule) << " is not read";
    }
  }
}

TEST(GltfExtensions, EachTextureOfMaterialsIsReadAndVisited) {
  for (const Extension* extension : extensions_of_materials()) {
    for (const Rule& rule : rules_of(*extension)) {
      if (!is_texture(rule)) continue;
      const std::string key(rule.key);
      const Material with = material_of(*extension, {{key, {{"index", 7}}}});
      EXPECT_FALSE(with == material_of(*extension, Json::object()))
          << name_of(*extension, rule) << " is not read";
      std::set<std::uint32_t> visited;
      for_each_texture(with,
                       [&](const TextureUse& use, ColorEncoding) { visited.insert(use.texture); });
      EXPECT_EQ(visited, std::set<std::uint32_t>{7})
          << name_of(*extension, rule) << " is not in scene/material_textures.hpp";
      for (const Rule& member : rule.members) {
        if (member.key == "index") continue;
        const Json changed = {{"index", 7}, {std::string(member.key), 3}};
        EXPECT_FALSE(material_of(*extension, {{key, changed}}) == with)
            << name_of(*extension, rule) << "/" << member.key << " is not read";
      }
    }
  }
}

/// Extension objects of a material, with the extensions' names.
using Objects = std::vector<std::pair<std::string, Json>>;

/// Path traces a cube with normals, tangents and texture coordinates.
std::vector<Vec3> picture_of(const Objects& objects) {
  AssetBuilder asset = cube();
  Json& attributes = asset.json["meshes"][0]["primitives"][0]["attributes"];
  std::vector<float> normals, tangents;
  for (int i = 0; i < 8; ++i) {
    for (const int axis : {0, 1, 2}) normals.push_back((i >> axis & 1) != 0 ? 0.577F : -0.577F);
    for (const float x : {0.707F, -0.707F, 0.0F, 1.0F}) tangents.push_back(x);
  }
  attributes["NORMAL"] = asset.add_numbers("VEC3", normals);
  attributes["TANGENT"] = asset.add_numbers("VEC4", tangents);
  attributes["TEXCOORD_0"] = asset.add_numbers("VEC2", std::vector<float>(16));
  asset.add("textures", {{"source", 0}});
  asset.add("images", {{"mimeType", "image/png"},
                       {"bufferView", asset.add_view(png_of(1, 1, {200, 60, 90, 120}))}});
  Json& material = asset.json["materials"][0];
  material = {{"emissiveFactor", {0.125, 0.0625, 0.25}},
              {"pbrMetallicRoughness", {{"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}}};
  for (const auto& [name, object] : objects) {
    material["extensions"][name] = object;
    asset.json["extensionsUsed"].push_back(name);
  }
  Scene scene = load(asset).scene;
  scene.environment = Environment{.content = Vec3(1, 0.75F, 0.5F)};
  const PathIntegrator integrator;
  const ImageSize size{8, 8};
  const Film film =
      render(scene, default_camera(scene, size), size, {.integrator = &integrator, .samples = 8});
  std::vector<Vec3> pixels;
  for (std::uint32_t y = 0; y < size.height; ++y) {
    pixels.insert(pixels.end(), film.row(y).begin(), film.row(y).end());
  }
  return pixels;
}

/// Returns true if the last of the extension objects changes the picture.
bool is_seen(Objects objects) {
  const std::vector<Vec3> with = picture_of(objects);
  objects.pop_back();
  return picture_of(objects) != with;
}

Json numbers_of(const Extension& extension) {
  Json object = Json::object();
  for (const Rule& rule : rules_of(extension)) {
    if (!is_texture(rule)) object[std::string(rule.key)] = value_of(rule);
  }
  return object;
}

TEST(GltfExtensions, OfMaterialsAreDrawn) {
  // Some extensions affect only refraction or media that attenuate light.
  const Objects glass = {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
                         {"KHR_materials_volume",
                          {{"thicknessFactor", 1},
                           {"attenuationDistance", 0.5},
                           {"attenuationColor", {0.5, 0.75, 0.25}}}}};
  for (const Extension* extension : extensions_of_materials()) {
    const std::string name(extension->name);
    const Json numbers = numbers_of(*extension);
    Objects within = glass;
    std::erase_if(within, [&](const auto& object) { return object.first == name; });
    within.emplace_back(name, numbers);
    const bool alone = is_seen({{name, numbers}});
    EXPECT_TRUE(alone || is_seen(within)) << name << " changes no picture";
    for (const Rule& rule : rules_of(*extension)) {
      // Only whether the thickness factor is positive matters, so its texture changes no picture.
      if (!is_texture(rule) || rule.key == "thicknessTexture") continue;
      Json textured = numbers;
      textured[rule.key] = {{"index", 0}};
      EXPECT_TRUE(picture_of({{name, textured}}) != picture_of({{name, numbers}}))
          << name_of(*extension, rule) << " changes no picture";
    }
  }
}

std::string text_of(const char* path) {
  std::ifstream file(source_folder() / path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(GltfExtensions, EachPropertyThatIsReadHasARule) {
  std::set<std::string, std::less<>> keys = {"scale"};  // a property of normal textures
  for (const Extension* extension : extensions_of_materials()) {
    for (const Rule& rule : rules_of(*extension)) keys.emplace(rule.key);
  }
  const std::string text = text_of("src/io/gltf/extensions/material_extensions.cpp");
  const std::regex read("(?:number|vector|texture_use|find)\\((?:\\*?\\w+, )?\"(\\w+)\"");
  std::size_t count = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), read); at != std::sregex_iterator();
       ++at, ++count) {
    EXPECT_TRUE(keys.contains((*at)[1].str())) << (*at)[1] << " has no rule";
  }
  EXPECT_GT(count, keys.size());
}

/// Returns the extension names between two headings of docs/gltf.md. A table row may abbreviate
/// names to their endings: `KHR_materials_ior`, `_specular`.
std::set<std::string> documented(const std::string& heading, const std::string& next) {
  std::string text = text_of("docs/gltf.md");
  text = text.substr(text.find(heading));
  text.resize(text.find(next));
  const std::regex name(
      "`((?:KHR_materials|AGI|BLENDER|CESIUM|EXT|FB|GODOT|KHR|MOZ|MSFT|OMI|VRMC)?_(?:[a-z]\\w*|RTC)"
      "|VRM)`");
  std::set<std::string> result;
  for (std::sregex_iterator at(text.begin(), text.end(), name); at != std::sregex_iterator();
       ++at) {
    const std::string found = (*at)[1];
    result.insert(found[0] == '_' ? "KHR_materials" + found : found);
  }
  return result;
}

TEST(GltfExtensions, WithoutEffectMayBeRequired) {
  for (const Extension& extension : extensions()) {
    if (extension.support != Support::harmless) continue;
    AssetBuilder asset = cube();
    asset.json["extensionsUsed"] = asset.json["extensionsRequired"] =
        Json::array({std::string(extension.name)});
    const LoadedScene loaded = load(asset);
    EXPECT_EQ(loaded.scene.objects.size(), 1U) << extension.name;
    EXPECT_THAT(texts(loaded.warnings), testing::ElementsAre(testing::HasSubstr("is ignored")));
  }
}

TEST(GltfExtensions, DefineAttributes) {
  AssetBuilder asset = cube();
  Json& attributes = asset.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["KHR_gaussian_splatting:SCALE"] = attributes["POSITION"];
  EXPECT_THAT(texts(load(asset).warnings),
              testing::ElementsAre(testing::HasSubstr("is not a glTF 2.0 attribute")));
  asset.json["extensionsUsed"] = {"KHR_gaussian_splatting"};
  EXPECT_THAT(texts(load(asset).warnings),
              testing::ElementsAre(testing::HasSubstr("is not supported")));
}

TEST(GltfExtensions, AreDocumented) {
  std::set<std::string> supported, ignored;
  for (const Extension& extension : extensions()) {
    (extension.support == Support::full ? supported : ignored).emplace(extension.name);
  }
  EXPECT_EQ(documented("\n## Supported", "\n## Ignored"), supported);
  EXPECT_EQ(documented("\n## Ignored", "\n## No effect"), ignored);
}

}  // namespace
}  // namespace microtrace::tests
