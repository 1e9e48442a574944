#include "cli/view/picture_json.hpp"

#include "cli/options/option.hpp"

#include <microtrace/version.h>

#include <cmath>
#include <numbers>
#include <variant>

#include <nlohmann/json.hpp>

namespace microtrace::cli {
namespace {

using Json = nlohmann::ordered_json;

Json array_of(const DVec3& v) {
  return {v.x, v.y, v.z};
}

/// Returns an angle in degrees. Conversion to radians and back may change the last digits.
double degrees(double radians) {
  constexpr double kResolution = 1e-9;
  return std::round(radians * 180 / std::numbers::pi / kResolution) * kResolution;
}

/// Strings from files may contain bytes that are not UTF-8, which are replaced.
std::string text_of(const Json& json, bool is_ascii = false) {
  return json.dump(-1, ' ', is_ascii, Json::error_handler_t::replace);
}

Json camera_json(const PictureJob& job) {
  constexpr std::array kKinds{"perspective", "orthographic", "environment", "calibrated"};
  const CameraModel model = RayGenerator(job.camera, job.size).model();
  const DMat4& frame = model.world_from_camera;
  Json camera{{"kind", kKinds[job.camera.index()]},
              {"eye", array_of(DVec3(frame[3]) + job.scene->prepared.scene().origin)},
              {"right", array_of(DVec3(frame[0]))},
              {"up", array_of(DVec3(frame[1]))},
              {"forward", array_of(-DVec3(frame[2]))}};
  if (job.camera.index() == 0 || job.camera.index() == 3) {
    const double slope = job.size.height / (2 * model.pixels_per_unit.y);
    camera["fov"] = 360 / std::numbers::pi * std::atan(slope);
  }
  return camera;
}

Json object_of(const PictureDescription& d) {
  return {{"request", d.request},      {"revision", d.revision},  {"samples", d.samples},
          {"of", d.requested_samples}, {"preview", d.is_preview}, {"done", d.is_done},
          {"seconds", d.seconds}};
}

Json names_of_option(std::string_view name) {
  for (const OptionGroup& group : option_groups(Command::view)) {
    for (const Option& option : group.options) {
      if (option.name() == name && option.words != nullptr) return option.words();
    }
  }
  return Json::array();
}

/// Returns what does not depend on the content of the scene file.
Json object_of(const SceneDescription& description) {
  return {{"name", description.name},
          {"version", MICROTRACE_VERSION_TEXT},
          {"revision", description.revision},
          {"scenes", description.scenes},
          {"words", description.words},
          {"integrators", names_of_option("--integrator")},
          {"tonemaps", names_of_option("--tonemap")},
          {"views", names_of_option("--view")}};
}

}  // namespace

std::string json_of(const PictureDescription& description) {
  return text_of(object_of(description), true);
}

std::string json_of(const PictureDescription& description, const PictureJob& job) {
  Json json = object_of(description);
  const PixelRect part =
      job.options.crop.value_or(PixelRect{.x1 = job.size.width, .y1 = job.size.height});
  json["x"] = part.x0;
  json["y"] = part.y0;
  json["width"] = part.size().width;
  json["height"] = part.size().height;
  json["integrator"] = job.arguments.is_path_traced() ? "path" : "exact";
  json["camera"] = camera_json(job);
  json["omitted"] = job.omitted;
  if (job.warning) json["warning"] = job.warning->message;
  return text_of(json, true);
}

std::string with_sequence(const std::string& object, std::uint64_t sequence) {
  return "{\"sequence\":" + std::to_string(sequence) + "," + object.substr(1);
}

std::string error_json(const std::string& error) {
  return text_of({{"error", error}});
}

std::string scene_json(const SceneDescription& description, const ShownScene& shown) {
  const Scene& scene = shown.prepared.scene();
  const Environment environment = scene.environment.value_or(Environment{});
  Json json = object_of(description);
  json.update({{"format", shown.format == SceneFormat::gltf ? "gltf" : "json"},
               {"width", scene.size.width},
               {"height", scene.size.height},
               {"center", array_of(shown.center)},
               {"distance", shown.distance},
               {"objects", scene.objects.size()},
               {"primitives", shown.prepared.bvh().primitives().count()},
               {"lights", scene.lights.size()},
               {"env_rotation", degrees(environment.rotation)},
               {"env_intensity", environment.intensity},
               {"cameras", Json::array()},
               {"variants", shown.choices.variants},
               {"animations", Json::array()},
               {"warnings", Json::array()}});
  for (const NamedCamera& camera : scene.cameras) json["cameras"].push_back(camera.name);
  for (const SceneChoices::Animation& animation : shown.choices.animations)
    json["animations"].push_back({{"name", animation.name}, {"end", animation.end}});
  for (const Diagnostic& warning : shown.warnings) {
    json["warnings"].push_back({{"file", warning.file},
                                {"line", warning.line},
                                {"column", warning.column},
                                {"pointer", warning.pointer},
                                {"message", warning.message}});
  }
  return text_of(json);
}

std::string scene_json(const SceneDescription& description, const std::string& error) {
  Json json = object_of(description);
  json["error"] = error;
  return text_of(json);
}

}  // namespace microtrace::cli
