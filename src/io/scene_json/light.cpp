#include "io/scene_json/light.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "io/scene_json/path.hpp"
#include "scene/math/trigonometry.hpp"

#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace::io {
namespace {

DVec3 read_direction(const JsonReader& json) {
  const DVec3 v = json.vector();
  if (Vec3(v) == Vec3(0)) json.fail("must not be zero");
  return v / std::sqrt(glm::dot(v, v));
}

template <typename AnyLight>
void read_common(const JsonReader& json, const Colors& colors, AnyLight& light) {
  if (const auto color = json.find("color")) light.color = read_color(*color, colors);
  if (const auto intensity = json.find("intensity")) {
    light.intensity = read_at_least(*intensity, 0);
  }
}

DirectionalLight read_directional(const JsonReader& json, const Colors& colors) {
  json.require_object({"name", "type", "color", "intensity", "direction"});
  DirectionalLight light{.direction = read_direction(json.member("direction"))};
  read_common(json, colors, light);
  return light;
}

PointLight read_point(const JsonReader& json, const Colors& colors) {
  json.require_object({"name", "type", "color", "intensity", "position"});
  PointLight light{.position = json.member("position").vector()};
  read_common(json, colors, light);
  return light;
}

SpotLight read_spot(const JsonReader& json, const Colors& colors) {
  json.require_object({"name", "type", "color", "intensity", "position", "direction", "inner_angle",
                       "outer_angle"});
  SpotLight light{.position = json.member("position").vector(),
                  .direction = read_direction(json.member("direction"))};
  read_common(json, colors, light);
  const auto angle = [&](const char* key, double standard) {
    const auto member = json.find(key);
    const double degrees = member ? member->number() : standard;
    if (degrees >= 0 && degrees <= 90) return degrees;
    member->fail("must lie between 0 and 90 degrees, is " + decimal(degrees));
  };
  const double inner = angle("inner_angle", 0), outer = angle("outer_angle", 45);
  if (!(inner < outer)) json.fail("must have an inner_angle smaller than its outer_angle");
  light.inner_angle = radians_from_degrees(inner);
  light.outer_angle = radians_from_degrees(outer);
  return light;
}

std::shared_ptr<const RadianceMap> read_map(const JsonReader& json,
                                            const std::filesystem::path& folder,
                                            std::vector<Diagnostic>& warnings) {
  const std::filesystem::path path = folder / read_relative_path(json);
  try {
    LoadedRadianceMap loaded = load_radiance_map(path, memory_account().budget());
    std::move(loaded.warnings.begin(), loaded.warnings.end(), std::back_inserter(warnings));
    return std::move(loaded.map);
  } catch (const Error& error) {
    json.fail(printable(path.string()) + ": " + error.diagnostic().message, error);
  }
}

}  // namespace

Light read_light(const JsonReader& json, const Colors& colors) {
  json.require_object();
  const JsonReader type = json.member("type");
  const std::string name = type.string();
  if (name == "directional") return read_directional(json, colors);
  if (name == "point") return read_point(json, colors);
  if (name == "spot") return read_spot(json, colors);
  type.fail_unknown("type", name, {"directional", "point", "spot"});
}

Environment read_environment(const JsonReader& json, const Colors& colors,
                             const std::filesystem::path& folder,
                             std::vector<Diagnostic>& warnings) {
  json.require_object();
  const JsonReader type = json.member("type");
  const std::string name = type.string();
  Environment result;
  if (name == "uniform") {
    json.require_object({"type", "color", "intensity", "visible"});
    result.content = read_color(json.member("color"), colors, kMaxRadiance);
  } else if (name == "map") {
    json.require_object({"type", "file", "rotation", "intensity", "visible"});
    result.content = read_map(json.member("file"), folder, warnings);
  } else if (name == "studio") {
    json.require_object({"type", "rotation", "intensity", "visible"});
    result.content = Studio{};
  } else {
    type.fail_unknown("type", name, {"uniform", "map", "studio"});
  }
  if (const auto turn = json.find("rotation")) {
    result.rotation = radians_from_degrees(turn->number());
  }
  if (const auto factor = json.find("intensity")) result.intensity = read_at_least(*factor, 0);
  const auto visible = json.find("visible");
  result.is_background = !visible || read_boolean(*visible);
  return result;
}

}  // namespace microtrace::io
