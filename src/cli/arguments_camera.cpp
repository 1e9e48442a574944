#include "cli/arguments_camera.hpp"

#include "scene/trigonometry.hpp"
#include "scene/validate.hpp"

#include <microtrace/error.hpp>

#include <cstddef>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {

void add_camera_options(CLI::App& app, Viewpoint& viewpoint) {
  app.add_option("-c,--camera", viewpoint.camera, "camera, by name or by number from 0 [the first]")
      ->type_name("NAME");
  app.add_option_function<std::string>(
         "--view", [&](const std::string& text) { viewpoint.orbit = parse_view(text); },
         "look at the whole scene from front, back, left, right, top, bottom, iso or "
         "AZIMUTH,ELEVATION in degrees: 0,0 is +z, the front, 90,0 is +x; or with "
         "AZIMUTH,ELEVATION,DISTANCE from so far away from the target [30,25 where the scene has "
         "no camera]")
      ->type_name("VIEW")
      ->excludes("--camera");
  app.add_option_function<std::string>(
         "--eye", [&](const std::string& text) { viewpoint.eye = parse_point("--eye", text); },
         "x,y,z: stand there and look at the target")
      ->type_name("POINT")
      ->excludes("--camera")
      ->excludes("--view");
  app.add_option_function<std::string>(
         "--target",
         [&](const std::string& text) { viewpoint.target = parse_point("--target", text); },
         "x,y,z: what --eye, or --view with a distance, looks at [the middle of the scene's "
         "bounding box]")
      ->type_name("POINT");
  app.add_option_function<std::string>(
         "--up", [&](const std::string& text) { viewpoint.up = parse_point("--up", text); },
         "x,y,z: the direction that --eye has above [0,1,0]")
      ->type_name("VECTOR")
      ->needs("--eye");
  app.add_option_function<std::string>(
         "--fov",
         [&](const std::string& text) {
           const double fov = parse_number("--fov", text);
           if (!(fov > 0 && fov < 180))
             throw CLI::ValidationError("--fov", "must be between 0 and 180, is " + text);
           viewpoint.vertical_fov = fov;
         },
         "opening angle of --view's and --eye's camera over the picture's height, in degrees [45]")
      ->type_name("DEGREES");
}

void finish_camera(const CLI::App& app, Viewpoint& viewpoint) {
  if (viewpoint.orbit) viewpoint.orbit->view.vertical_fov = viewpoint.vertical_fov;
  const bool is_distant = viewpoint.eye || (viewpoint.orbit && viewpoint.orbit->distance);
  if (viewpoint.target && !is_distant)
    throw CLI::RequiredError("--eye, or --view with a distance, where --target is given,");
  if (app.count("--fov") > 0 && viewpoint.is_of_scene())
    throw CLI::RequiredError("--view or --eye, where --fov is given,");
}

Framing framing_for(const Viewpoint& viewpoint, ImageSize size) {
  return {viewpoint.orbit.value_or(OrbitView{}).view, size};
}

PerspectiveCamera camera_of(const Framing& framing, const Viewpoint& viewpoint) {
  const DVec3 target = viewpoint.target ? *viewpoint.target - framing.origin() : framing.center();
  if (viewpoint.orbit && viewpoint.orbit->distance)
    return framing.camera_around(target, *viewpoint.orbit->distance);
  if (!viewpoint.eye) return framing.camera();
  const DVec3 eye = *viewpoint.eye - framing.origin();
  const PerspectiveCamera camera{
      .pose = {.position = eye, .direction = target - eye, .up = viewpoint.up},
      .vertical_fov = radians_from_degrees(viewpoint.vertical_fov)};
  if (const auto problem = validate(camera)) {
    const bool is_same = problem->field == "direction";
    throw Error(ErrorKind::usage, "",
                is_same ? "--eye: is the target; give another one by --target"
                        : "--up: must not be parallel to the direction from --eye to the target");
  }
  return camera;
}

Camera choose_camera(const Scene& scene, const Viewpoint& viewpoint, ImageSize size) {
  if (!viewpoint.is_of_scene()) {
    Framing framing = framing_for(viewpoint, size);
    framing.add(scene);
    return camera_of(framing, viewpoint);
  }
  const std::string& wanted = viewpoint.camera;
  if (wanted.empty()) return default_camera(scene, size);
  for (const NamedCamera& camera : scene.cameras) {
    if (camera.name == wanted) return camera.camera;
  }
  const auto index = whole_number(wanted);
  if (index && *index < scene.cameras.size()) return scene.cameras[*index].camera;
  std::string message = "--camera: there is no camera " + wanted + "; the scene has";
  if (scene.cameras.empty()) message += " none: leave --camera out, or use --view or --eye";
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    message += i == 0 ? " " : ", ";
    message += std::to_string(i) + " (" + scene.cameras[i].name + ")";
  }
  throw Error(ErrorKind::usage, "", message);
}

}  // namespace microtrace::cli
