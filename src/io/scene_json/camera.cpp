#include "io/scene_json/camera.hpp"

#include "scene/math/trigonometry.hpp"

namespace microtrace::io {
namespace {

Pose read_pose(const JsonReader& json) {
  Pose pose{.position = json.member("position").vector(),
            .direction = json.member("direction").vector()};
  if (const auto up = json.find("up")) pose.up = up->vector();
  return pose;
}

PerspectiveCamera read_perspective(const JsonReader& json) {
  json.require_object({"name", "type", "position", "direction", "up", "vertical_fov", "focus"});
  PerspectiveCamera camera;
  camera.pose = read_pose(json);
  const JsonReader fov = json.member("vertical_fov");
  const double degrees = fov.number();
  if (!(degrees > 0 && degrees < 180)) {
    fov.fail(std::string("must lie between 0 and 180 degrees, is ").append(decimal(degrees)));
  }
  camera.vertical_fov = radians_from_degrees(degrees);
  if (const auto focus = json.find("focus")) camera.focus = focus->number();
  return camera;
}

OrthographicCamera read_orthographic(const JsonReader& json) {
  json.require_object({"name", "type", "position", "direction", "up", "height"});
  OrthographicCamera camera;
  camera.pose = read_pose(json);
  camera.height = json.member("height").number();
  return camera;
}

EnvironmentCamera read_environment(const JsonReader& json) {
  json.require_object({"name", "type", "position", "direction", "up"});
  return {.pose = read_pose(json)};
}

Camera read_kind(const JsonReader& json) {
  json.require_object();
  const JsonReader type = json.member("type");
  const std::string name = type.string();
  if (name == "perspective") return read_perspective(json);
  if (name == "orthographic") return read_orthographic(json);
  if (name == "environment") return read_environment(json);
  type.fail_unknown("type", name, {"perspective", "orthographic", "environment"});
}

}  // namespace

Camera read_camera(const JsonReader& json) {
  Camera camera = read_kind(json);
  json.require(validate(camera));
  return camera;
}

}  // namespace microtrace::io
