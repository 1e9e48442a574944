#include "base/system/float_environment.hpp"
#include "dataset/npz_views.hpp"
#include "io/file.hpp"
#include "io/json/reader.hpp"
#include "io/scene_json/camera.hpp"
#include "io/scene_json/image_size.hpp"

#include <microtrace/dataset.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace microtrace {
namespace {

using io::JsonReader;

/// Returns a name that can be part of a file name.
std::string read_name(const JsonReader& json) {
  std::string name = json.name();
  const bool is_safe = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  });
  if (!is_safe || name.front() == '.')
    json.fail("must consist of letters, digits, '_', '-' and '.', and must not begin with '.'");
  return name;
}

View read_direction(const JsonReader& json) {
  json.require_object({"azimuth", "elevation", "vertical_fov"});
  View view{.azimuth = json.member("azimuth").number(),
            .elevation = json.member("elevation").number()};
  if (!(std::abs(view.elevation) <= 90)) json.member("elevation").fail("must be from -90 to 90");
  if (const auto fov = json.find("vertical_fov")) {
    view.vertical_fov = fov->number();
    if (!(view.vertical_fov > 0 && view.vertical_fov < 180))
      fov->fail("must lie between 0 and 180 degrees");
  }
  return view;
}

std::variant<std::string, Camera, View> read_view_camera(const JsonReader& json) {
  using Kind = io::JsonValue::Kind;
  if (json.value().kind() == Kind::string) return json.name();
  if (json.value().kind() == Kind::object && json.find("azimuth")) return read_direction(json);
  return io::read_camera(json);
}

DatasetView read_view(const JsonReader& json, DatasetView view) {
  json.require_object({"name", "camera", "size", "time", "variant", "environment"});
  if (const auto name = json.find("name")) view.name = read_name(*name);
  if (const auto camera = json.find("camera")) view.camera = read_view_camera(*camera);
  if (const auto size = json.find("size")) view.size = io::read_image_size(*size);
  if (const auto time = json.find("time")) {
    view.time = time->number();
    if (!(*view.time >= 0)) time->fail("must not be negative");
  }
  if (const auto variant = json.find("variant")) view.variant = variant->name();
  if (const auto environment = json.find("environment")) {
    environment->require_object({"light", "rotation", "intensity"});
    if (const auto light = environment->find("light")) view.environment = light->name();
    if (const auto rotation = environment->find("rotation"))
      view.environment_rotation = rotation->number();
    if (const auto intensity = environment->find("intensity")) {
      view.environment_intensity = intensity->number();
      if (!(*view.environment_intensity >= 0)) intensity->fail("must not be negative");
    }
  }
  return view;
}

}  // namespace

std::vector<DatasetView> read_views(const std::filesystem::path& path,
                                    const std::optional<ImageSize>& image) {
  const FloatEnvironment environment;
  const std::string text = io::read_file(path, io::kMaxFileSize);
  if (dataset::is_npz(text)) return dataset::read_npz_views(text, path.string(), image);
  const io::JsonDocument document(text, path.string());
  const JsonReader root(document);
  root.require_object({"defaults", "views"});
  DatasetView defaults;
  if (const auto json = root.find("defaults")) defaults = read_view(*json, {});
  std::vector<DatasetView> views;
  const std::vector<JsonReader> items = root.member("views").items();
  views.reserve(items.size());
  for (const JsonReader& item : items) views.push_back(read_view(item, defaults));
  if (views.empty()) root.member("views").fail("must have at least one view");
  return views;
}

}  // namespace microtrace
