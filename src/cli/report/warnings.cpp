#include "cli/report/warnings.hpp"

#include "base/counted.hpp"
#include "cli/camera.hpp"
#include "cli/report/progress_bar.hpp"
#include "cli/report/validation_result.hpp"
#include "scene/material_textures.hpp"
#include "scene/support.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <variant>

namespace microtrace::cli {
namespace {

std::string camera_name(const Arguments& arguments, const Scene& scene) {
  const auto index = camera_index(scene, arguments.camera);
  return index ? "the camera " + scene.cameras[*index].name : "the camera";
}

bool has_object(const Scene& scene, const auto& predicate) {
  for (const ObjectRun& run : scene.objects.runs())
    if (predicate(*run.first)) return true;
  return false;
}

/// What to do if nothing is visible. Of a scene with one-sided surfaces, a camera that frames the
/// whole scene may see only their backs, whose fronts the opposite camera sees.
std::string remedy_for_emptiness(const CameraOptions& options, const Scene& scene) {
  const bool is_default = options.is_of_scene() && scene.cameras.empty();
  const bool is_framed = is_default || (options.orbit && !options.orbit->distance);
  if (!is_framed)
    return "choose another one with --camera, or frame the whole scene with --view 30,25";
  if (!has_object(scene, [&](const Object& o) { return !material_of(scene, o).double_sided; }))
    return "its objects may be empty, transparent or smaller than a pixel; `microtrace explain` "
           "tells why rays miss them";
  return std::string("its surfaces may be one-sided and face away; look from ")
      .append(is_default ? "the opposite side with --view 210,-25" : "another side with --view");
}

bool is_dark(const Light& light) {
  return std::visit([](const auto& l) { return l.intensity == 0 || l.color == Vec3(0); }, light);
}

bool is_dark(const Environment& environment) {
  const auto* radiance = std::get_if<Vec3>(&environment.content);
  return environment.intensity == 0 || (radiance != nullptr && *radiance == Vec3(0));
}

bool has_emissive_surfaces(const Scene& scene) {
  return has_object(scene, [&](const Object& o) { return is_emissive(material_of(scene, o)); });
}

/// Returns true if light comes from all directions.
bool is_surrounded_by_light(const Scene& scene) {
  return scene.environment ? !is_dark(*scene.environment) : scene.lights.empty();
}

/// Returns the exposure in stops that raises this value to at least 1/2.
int exposure_for(float brightest) {
  int exponent = 0;
  std::frexp(brightest, &exponent);
  return std::clamp(-exponent, 1, 64);
}

Diagnostic warning_about(const Arguments& arguments, std::string message) {
  return {.file = arguments.scene,
          .pointer = {},
          .message = std::move(message),
          .excerpt = {},
          .severity = Severity::warning};
}

}  // namespace

void Warnings::print(const Diagnostic& warning) const {
  if (is_strict_) throw Error(ErrorKind::invalid_scene, warning);
  if (is_quiet_) return;
  if (collected_ != nullptr) {
    collected_->push_back(warning);
    return;
  }
  const bool is_error = is_validating_ && warning.severity == Severity::error;
  clear_progress_bar();
  std::fprintf(stderr, "%s: %s\n", is_error ? "error" : "warning", warning.text().c_str());
}

void Warnings::report(const std::vector<Diagnostic>& warnings) {
  for (const Diagnostic& warning : warnings) {
    if (!printed_.insert(warning.text()).second) continue;
    errors_ += warning.severity == Severity::error ? 1 : 0;
    print(warning);
  }
}

int Warnings::print_result(const std::string& scene) const {
  print_validation_result(scene, errors_, printed_.size() - errors_);
  return errors_ == 0 ? 0 : static_cast<int>(ErrorKind::invalid_scene);
}

void Warnings::report_picture(const std::optional<Diagnostic>& warning, std::string_view kind) {
  if (warning && kinds_of_pictures_.emplace(kind).second) print(*warning);
}

std::string lights_text(const Scene& scene) {
  if (!scene.environment && scene.lights.empty()) return "the built-in studio";
  const std::size_t lights = scene.lights.size();
  const auto dark = static_cast<std::size_t>(std::ranges::count_if(
      scene.lights, [](const NamedLight& light) { return is_dark(light.light); }));
  std::string text = counted(lights, "light");
  if (dark > 0)
    text += dark == lights ? " of intensity 0" : " (" + std::to_string(dark) + " of intensity 0)";
  if (has_emissive_surfaces(scene)) text += ", emissive surfaces";
  if (!scene.environment) return text + ", no environment";
  return text + (is_dark(*scene.environment) ? ", a black environment" : ", an environment");
}

std::optional<Diagnostic> ground_warning(const Arguments& arguments, const Scene& scene) {
  if (!arguments.path.ground || arguments.path.ground->height || has_bounded_object(scene))
    return std::nullopt;
  return warning_about(
      arguments,
      "no object is bounded, so the scene has no lowest point for --ground; give a "
      "height, as in --ground=0");
}

std::optional<Diagnostic> picture_warning(const FilmView& view, const Arguments& arguments,
                                          const Scene& scene) {
  if (view.is_empty && !arguments.crop && !scene.objects.empty()) {
    return warning_about(arguments, camera_name(arguments, scene) + " sees nothing of the scene; " +
                                        remedy_for_emptiness(arguments.camera, scene));
  }
  if (!view.is_dark || !arguments.is_path_traced() || arguments.path.max_depth == 1)
    return std::nullopt;
  std::string message = "most of the visible scene is black; it is lit by " + lights_text(scene);
  if (!scene.environment && !scene.lights.empty())
    message += " (the studio lights only scenes without lights)";
  message += is_surrounded_by_light(scene)
                 ? "; the camera may be inside a closed object; look from outside with --view 30,25"
                 : "; add light with --env studio";
  if (view.brightest > 0)
    message +=
        ", or brighten the picture with --exposure " + std::to_string(exposure_for(view.brightest));
  return warning_about(arguments, std::move(message));
}

}  // namespace microtrace::cli
