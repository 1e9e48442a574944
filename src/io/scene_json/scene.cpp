#include "io/scene_json/scene.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "io/confined_reads.hpp"
#include "io/json/reader.hpp"
#include "io/scene_json/camera.hpp"
#include "io/scene_json/color.hpp"
#include "io/scene_json/image_size.hpp"
#include "io/scene_json/light.hpp"
#include "io/scene_json/material.hpp"
#include "io/scene_json/mesh.hpp"
#include "io/scene_json/names.hpp"
#include "io/scene_json/shape.hpp"
#include "scene/mesh/merge.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <unordered_map>
#include <utility>
#include <variant>

namespace microtrace::io {
namespace {

float read_epsilon(const JsonReader& json) {
  const double x = json.number();
  if (x < 0) json.fail(std::string("must not be negative, is ").append(decimal(x)));
  return static_cast<float>(x);
}

void require_version(const JsonReader& json) {
  const std::uint64_t version = json.count();
  if (version == 1) return;
  json.fail(std::string("must be 1, the version that this program reads, is ")
                .append(decimal(static_cast<double>(version))));
}

std::vector<JsonReader> read_filled_array(const JsonReader& json) {
  std::vector<JsonReader> items = json.items();
  if (items.empty()) json.fail("must have at least one item");
  return items;
}

void read_cameras(const JsonReader& json, Scene& scene) {
  Names names;
  for (const JsonReader& item : read_filled_array(json)) {
    const Camera camera = read_camera(item);
    scene.cameras.push_back({.name = names.read(item), .camera = camera});
  }
}

/// Returns the picture size for the default camera.
ImageSize default_size(const Scene& scene) {
  if (scene.cameras.empty()) return {};
  const auto* calibrated = std::get_if<CalibratedCamera>(&scene.cameras.front().camera);
  return calibrated != nullptr ? calibrated->image : ImageSize{};
}

void read_lights(const JsonReader& json, const Colors& colors, Scene& scene) {
  Names names;
  for (const JsonReader& item : read_filled_array(json)) {
    const Light light = read_light(item, colors);
    scene.lights.push_back({.name = names.read(item), .light = light});
  }
}

bool is_mesh(const JsonReader& json) {
  json.require_object();
  const auto type = json.find("type");
  return type && type->value().kind() == JsonValue::Kind::string &&
         type->value().string() == "mesh";
}

/// The scene's named materials, and one material for each color that objects use.
class Palette {
 public:
  Palette(const Colors& colors, Scene& scene) : colors_(colors), scene_(scene) {}

  void name_materials(const JsonReader& json) {
    for (const auto& [name, item] : json.members()) {
      named_.emplace(name, static_cast<std::uint32_t>(scene_.materials.size()));
      add(read_material(item, colors_));
      scene_.materials.back().name = name;
    }
  }

  /// Reads the object's member "material" or "color", if it has one, and returns the material's
  /// index.
  std::optional<std::uint32_t> read(const JsonReader& object) {
    const auto color = object.find("color");
    if (const auto name = object.find("material")) {
      if (color) name->fail("must not be combined with color");
      return find(*name);
    }
    if (!color) return std::nullopt;
    const Vec3 rgb = read_color(*color, colors_);
    const auto next = static_cast<std::uint32_t>(scene_.materials.size());
    const auto [known, is_new] = plain_.try_emplace({rgb.x, rgb.y, rgb.z}, next);
    if (is_new) add({.base_color = Vec4(rgb, 1)});
    return known->second;
  }

 private:
  void add(Material material) {
    take_memory(sizeof(Material), "the materials of the scene");
    scene_.materials.push_back(std::move(material));
  }

  std::uint32_t find(const JsonReader& json) const {
    const std::string name = json.string();
    const auto found = named_.find(name);
    if (found != named_.end()) return found->second;
    if (named_.empty()) json.fail("is a name, but the scene names no materials in /materials");
    std::vector<std::string_view> names;
    for (const auto& [known, index] : named_) names.push_back(known);
    json.fail_unknown("material", name, names);
  }

  const Colors& colors_;
  Scene& scene_;
  std::map<std::string, std::uint32_t> named_;
  std::map<std::array<float, 3>, std::uint32_t> plain_;
};

/// Adds the objects of a mesh. If the JSON object has a material, it replaces the materials in the
/// mesh's file.
void add_mesh(const JsonReader& json, const std::string& name,
              std::optional<std::uint32_t> material, MeshFiles& files, LoadedScene& out) {
  LoadedScene mesh = files.read(json);
  (void)mesh.scene.objects.edit();  // because each object gets a name of its own
  const std::size_t first = out.scene.objects.size();
  merge(out.scene, std::move(mesh.scene));
  for (std::size_t i = first; i < out.scene.objects.size(); ++i) {
    Object& object = out.scene.objects[i];
    object.name = std::string(name).append("/").append(object.name.str());
    if (material) object.material = material;
  }
  std::move(mesh.warnings.begin(), mesh.warnings.end(), std::back_inserter(out.warnings));
}

/// Throws Error if two objects have the same name. `firsts` has the index of each item's first
/// object.
void require_distinct_names(const std::vector<JsonReader>& items,
                            const std::vector<std::size_t>& firsts, const Objects& objects) {
  const auto item_of = [&](std::size_t object) -> const JsonReader& {
    const auto next = std::ranges::upper_bound(firsts, object);
    return items[static_cast<std::size_t>(next - firsts.begin()) - 1];
  };
  std::unordered_map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto [earlier, is_new] = known.emplace(objects[i].name.str(), i);
    if (is_new) continue;
    std::string message = "the name of its object ";
    message.append(in_quotes(earlier->first)).append(" is already used by ");
    item_of(i).fail(message.append(item_of(earlier->second).pointer()) + "; names must differ");
  }
}

void read_objects(const JsonReader& json, Palette& palette, const std::filesystem::path& folder,
                  const LoadOptions& options, LoadedScene& out) {
  Names names;
  const std::vector<JsonReader> items = read_filled_array(json);
  MeshFiles files(folder, options);
  for (const JsonReader& item : items) {
    const bool is_object = item.value().kind() == JsonValue::Kind::object;
    if (is_object && is_mesh(item)) files.expect(item);
  }
  bool has_meshes = false;
  std::vector<std::size_t> firsts;
  for (const JsonReader& item : items) {
    firsts.push_back(out.scene.objects.size());
    if (is_mesh(item)) {
      has_meshes = true;
      const std::string name = names.read(item);
      add_mesh(item, name, palette.read(item), files, out);
      continue;
    }
    Object object;
    object.shape = read_shape(item);
    object.name = names.read(item);
    object.material = palette.read(item);
    out.scene.objects.push_back(std::move(object));
  }
  if (has_meshes) require_distinct_names(items, firsts, out.scene.objects);
}

}  // namespace

LoadedScene read_json_scene(const JsonDocument& document, const std::filesystem::path& folder,
                            const LoadOptions& options) {
  const ConfinedReads confined(folder, options.allowed_folders);
  const JsonReader root(document);
  root.require_object();
  require_version(root.member("version"));
  root.require_object({"$schema", "version", "image", "background", "epsilon", "colors",
                       "materials", "cameras", "lights", "environment", "objects"});
  LoadedScene out;
  if (const auto schema = root.find("$schema")) (void)schema->string();
  const auto image = root.find("image");
  if (image) out.scene.size = read_image_size(*image);
  Colors colors;
  if (const auto table = root.find("colors")) colors = read_colors(*table);
  if (const auto color = root.find("background")) out.scene.background = read_color(*color, colors);
  if (const auto epsilon = root.find("epsilon")) out.scene.epsilon = read_epsilon(*epsilon);
  if (const auto cameras = root.find("cameras")) read_cameras(*cameras, out.scene);
  if (!image) out.scene.size = default_size(out.scene);
  if (const auto lights = root.find("lights")) read_lights(*lights, colors, out.scene);
  if (const auto environment = root.find("environment")) {
    out.scene.environment = read_environment(*environment, colors, folder, out.warnings);
  }
  Palette palette(colors, out.scene);
  if (const auto materials = root.find("materials")) palette.name_materials(*materials);
  read_objects(root.member("objects"), palette, folder, options, out);
  return out;
}

}  // namespace microtrace::io
