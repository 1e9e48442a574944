#include "cli/pictures/shutter.hpp"

#include "cli/camera.hpp"
#include "cli/pictures/environment.hpp"

#include <utility>
#include <variant>

namespace microtrace::cli {
namespace {

/// A camera that stays where it is in world space, in the coordinates of a scene.
Camera still_camera(Camera camera, const DVec3& former_origin, const DVec3& origin) {
  std::visit([&](auto& c) { c.pose.position += former_origin - origin; }, camera);
  return camera;
}

}  // namespace

std::optional<Shutter> shutter_of(const MovingPicture& picture, const Scene& scene,
                                  const Camera& camera) {
  const std::optional<ShutterTimes>& relative = picture.arguments.shutter;
  if (!relative || picture.file.choices().animations.empty()) return std::nullopt;
  ShutterTimes times = *relative;
  times.open += picture.time;
  times.close += picture.time;
  const bool moves = picture.arguments.camera.is_of_scene() && !scene.cameras.empty();
  const auto moment = [picture, camera, moves, origin = scene.origin](double time) {
    const Arguments& arguments = picture.arguments;
    Scene posed = picture.file.at(time).scene;  // the warnings are those of the picture's scene
    apply_environment(posed, picture.environment, arguments.environment);
    Camera at = moves ? choose_camera(posed, arguments.camera, picture.size)
                      : still_camera(camera, origin, posed.origin);
    PreparedScene prepared(std::move(posed), {.threads = arguments.threads,
                                              .memory = arguments.load.memory,
                                              .tables = std::move(picture.tables)});
    picture.tables = prepared.tables();
    return Moment{.scene = std::move(prepared), .camera = at};
  };
  return Shutter{.times = times, .moment = moment};
}

}  // namespace microtrace::cli
