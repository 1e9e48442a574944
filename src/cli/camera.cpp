#include "cli/camera.hpp"

#include "base/text/named_items.hpp"
#include "scene/math/trigonometry.hpp"
#include "scene/validate/validate.hpp"

#include <string>
#include <variant>
#include <vector>

namespace microtrace::cli {

PerspectiveCamera camera_of(const Framing& framing, const CameraOptions& options) {
  const DVec3 target = options.target ? *options.target - framing.origin() : framing.center();
  if (options.orbit && options.orbit->distance)
    return framing.camera_around(target, *options.orbit->distance);
  if (!options.eye) return framing.camera();
  const DVec3 eye = *options.eye - framing.origin();
  const PerspectiveCamera camera{
      .pose = {.position = eye, .direction = target - eye, .up = options.up},
      .vertical_fov = radians_from_degrees(options.view().vertical_fov)};
  if (const auto problem = validate(camera)) {
    if (problem->field == "direction") {
      refuse_usage(target == eye ? "--eye: equals the target; choose another one with --target"
                                 : "--eye: the direction to the target " + problem->message);
    }
    if (problem->field == "position") refuse_usage("--eye: " + problem->message);
    refuse_usage("--up: " + problem->message);
  }
  return camera;
}

Camera with_lens(Camera camera, const CameraOptions& options) {
  if (!options.lens_radius && !options.focus) return camera;
  auto* perspective = std::get_if<PerspectiveCamera>(&camera);
  if (perspective == nullptr)
    refuse_usage("--focus: only perspective cameras have a lens; choose another camera");
  if (!options.lens_radius && perspective->lens_radius == 0)
    refuse_usage("--focus: this camera has no lens; add --aperture");
  perspective->lens_radius = options.lens_radius.value_or(perspective->lens_radius);
  perspective->focus = options.focus.value_or(perspective->focus);
  if (const auto problem = validate(camera)) refuse_usage("--aperture: " + problem->message);
  return camera;
}

namespace {

std::vector<std::string> camera_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const NamedCamera& camera : scene.cameras) names.push_back(camera.name);
  return names;
}

Camera camera_without_options(const Scene& scene, const CameraOptions& options, ImageSize size) {
  if (!options.is_of_scene()) {
    Framing framing(options.view(), size);
    if (options.eye && options.target) {
      // The bounds of the shapes, whose computation may take longer than a preview, don't matter.
      Scene empty;
      empty.origin = scene.origin;
      framing.add(empty);
    } else {
      framing.add(scene);
    }
    return camera_of(framing, options);
  }
  if (options.camera.empty()) return default_camera(scene, size);
  if (const std::optional<std::size_t> index = camera_index(scene, options))
    return scene.cameras[*index].camera;
  const std::vector<std::string> names = camera_names(scene);
  const char* advice = names.empty() ? ": omit --camera, or use --view or --eye" : "";
  refuse_usage(options.place + ": " + no_such_item("camera", options.camera, names) + advice);
}

}  // namespace

std::optional<std::size_t> camera_index(const Scene& scene, const CameraOptions& options) {
  if (!options.is_of_scene() || scene.cameras.empty()) return std::nullopt;
  return options.camera.empty() ? 0 : find_item(options.camera, camera_names(scene));
}

Camera choose_camera(const Scene& scene, const CameraOptions& options, ImageSize size) {
  return with_lens(camera_without_options(scene, options, size), options);
}

PerspectiveCamera in_coordinates_of(const Scene& scene, PerspectiveCamera camera) {
  camera.pose.position -= scene.origin;
  return camera;
}

}  // namespace microtrace::cli
