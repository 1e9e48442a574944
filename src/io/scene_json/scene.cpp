#include "io/scene_json/scene.hpp"

#include "io/json/excerpt.hpp"
#include "io/json/reader.hpp"
#include "io/scene_json/camera.hpp"
#include "io/scene_json/mesh.hpp"
#include "io/scene_json/shape.hpp"
#include "scene/merge.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <unordered_map>

namespace microtrace::io {
namespace {

using Colors = std::map<std::string, Vec3, std::less<>>;

Vec3 read_triple(const JsonReader& json) {
  for (const JsonReader& channel : json.items(3)) {
    const double x = channel.number();
    if (x >= 0 && x <= 1) continue;
    channel.fail(std::string("must lie between 0 and 1, is ").append(decimal(x)));
  }
  return json.vector32();
}

Colors read_colors(const JsonReader& json) {
  Colors colors;
  for (const auto& [name, color] : json.members()) colors.emplace(name, read_triple(color));
  return colors;
}

Vec3 read_color(const JsonReader& json, const Colors& colors) {
  if (json.value().kind == JsonValue::Kind::array) return read_triple(json);
  if (json.value().kind != JsonValue::Kind::string) {
    json.fail("must be three numbers from 0 to 1 or a name from /colors");
  }
  const auto found = colors.find(json.string());
  if (found != colors.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& [name, color] : colors) names.push_back(name);
  if (names.empty()) json.fail("is a name, but the scene names no colours in /colors");
  json.fail_unknown("colour name", json.string(), names);
}

/// A side of the picture; numbers too large for ImageSize stay too large.
std::uint32_t read_side(const JsonReader& json) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(json.count(), 0xFFFFFFFFU));
}

ImageSize read_image(const JsonReader& json) {
  json.require_object({"width", "height"});
  const ImageSize size{.width = read_side(json.member("width")),
                       .height = read_side(json.member("height"))};
  json.require(validate(size));
  return size;
}

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

/// The names within one array, unique.
class Names {
 public:
  /// The member "name", or where there is none the pointer without its first slash.
  std::string read(const JsonReader& json) {
    const auto given = json.find("name");
    std::string name = given ? given->name() : json.pointer().substr(1);
    const auto [earlier, is_new] = pointers_.emplace(name, json.pointer());
    if (!is_new) {
      std::string message = "the name ";
      message.append(in_quotes(name)).append(" is taken by ").append(earlier->second);
      (given ? *given : json).fail(message.append("; names must differ"));
    }
    return name;
  }

 private:
  std::unordered_map<std::string, std::string> pointers_;
};

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

bool is_mesh(const JsonReader& json) {
  json.require_object();
  const auto type = json.find("type");
  return type && type->value().kind == JsonValue::Kind::string && type->value().string == "mesh";
}

/// One material for each colour.
class Palette {
 public:
  Palette(const Colors& colors, Scene& scene) : colors_(colors), scene_(scene) {}

  /// The material of the object's member "color", if it has one.
  std::optional<std::uint32_t> read(const JsonReader& object) {
    const auto json = object.find("color");
    if (!json) return std::nullopt;
    const Vec3 color = read_color(*json, colors_);
    const auto next = static_cast<std::uint32_t>(scene_.materials.size());
    const auto [known, is_new] = materials_.try_emplace({color.x, color.y, color.z}, next);
    if (is_new) scene_.materials.push_back({.base_color = Vec4(color, 1)});
    return known->second;
  }

 private:
  const Colors& colors_;
  Scene& scene_;
  std::map<std::array<float, 3>, std::uint32_t> materials_;
};

/// A colour replaces the materials of the mesh's own file.
void add_mesh(const JsonReader& json, const std::string& name,
              std::optional<std::uint32_t> material, const std::filesystem::path& folder,
              const LoadOptions& options, LoadedScene& out) {
  LoadedScene mesh = read_mesh(json, folder, options);
  const std::size_t first = out.scene.objects.size();
  merge(out.scene, std::move(mesh.scene));
  for (std::size_t i = first; i < out.scene.objects.size(); ++i) {
    Object& object = out.scene.objects[i];
    object.name = std::string(name).append("/").append(object.name);
    if (material) object.material = material;
  }
  std::move(mesh.warnings.begin(), mesh.warnings.end(), std::back_inserter(out.warnings));
}

void read_objects(const JsonReader& json, const Colors& colors, const std::filesystem::path& folder,
                  const LoadOptions& options, LoadedScene& out) {
  Names names;
  Palette palette(colors, out.scene);
  for (const JsonReader& item : read_filled_array(json)) {
    if (is_mesh(item)) {
      const std::string name = names.read(item);
      add_mesh(item, name, palette.read(item), folder, options, out);
      continue;
    }
    Object object;
    object.shape = read_shape(item);
    object.name = names.read(item);
    object.material = palette.read(item);
    out.scene.objects.push_back(std::move(object));
  }
}

}  // namespace

LoadedScene read_json_scene(const JsonDocument& document, const std::filesystem::path& folder,
                            const LoadOptions& options) {
  const JsonReader root(document);
  root.require_object();
  require_version(root.member("version"));
  root.require_object(
      {"$schema", "version", "image", "background", "epsilon", "colors", "cameras", "objects"});
  LoadedScene out;
  if (const auto schema = root.find("$schema")) (void)schema->string();
  if (const auto image = root.find("image")) out.scene.size = read_image(*image);
  Colors colors;
  if (const auto table = root.find("colors")) colors = read_colors(*table);
  if (const auto color = root.find("background")) out.scene.background = read_color(*color, colors);
  if (const auto epsilon = root.find("epsilon")) out.scene.epsilon = read_epsilon(*epsilon);
  if (const auto cameras = root.find("cameras")) read_cameras(*cameras, out.scene);
  read_objects(root.member("objects"), colors, folder, options, out);
  return out;
}

}  // namespace microtrace::io
