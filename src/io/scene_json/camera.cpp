#include "io/scene_json/camera.hpp"

#include "io/scene_json/image_size.hpp"
#include "scene/math/trigonometry.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::io {
namespace {

Pose read_pose(const JsonReader& json) {
  Pose pose{.position = json.member("position").vector(),
            .direction = json.member("direction").vector()};
  if (const auto up = json.find("up")) pose.up = up->vector();
  return pose;
}

PerspectiveCamera read_perspective(const JsonReader& json) {
  json.require_object(
      {"name", "type", "position", "direction", "up", "vertical_fov", "focus", "lens_radius"});
  PerspectiveCamera camera;
  camera.pose = read_pose(json);
  const JsonReader fov = json.member("vertical_fov");
  const double degrees = fov.number();
  if (!(degrees > 0 && degrees < 180)) {
    fov.fail(std::string("must lie between 0 and 180 degrees, is ").append(decimal(degrees)));
  }
  camera.vertical_fov = radians_from_degrees(degrees);
  if (const auto focus = json.find("focus")) camera.focus = focus->number();
  if (const auto radius = json.find("lens_radius")) camera.lens_radius = radius->number();
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

/// Reads a rigid transform, given as the rows of OpenCV's 4 x 4 matrix.
DMat4 read_rigid_transform(const JsonReader& json) {
  DMat4 out(1);
  const std::vector<JsonReader> rows = json.items(4);
  for (glm::length_t r = 0; r < 4; ++r) {
    const std::vector<JsonReader> items = rows[static_cast<std::size_t>(r)].items(4);
    for (glm::length_t c = 0; c < 4; ++c) {
      const JsonReader& item = items[static_cast<std::size_t>(c)];
      out[c][r] = item.number();
      const double last = c == 3 ? 1 : 0;
      if (r == 3 && out[c][r] != last) {
        std::string message = "must be ";
        message.append(decimal(last)).append(" in a rigid transform, is ");
        item.fail(message.append(decimal(out[c][r])));
      }
    }
  }
  if (const char* message = broken_rotation(out)) json.fail(message);
  return out;
}

Distortion read_distortion(const JsonReader& json) {
  json.require_object();
  const JsonReader type = json.member("type");
  const std::string name = type.string();
  const auto number = [&](std::string_view key) {
    const auto member = json.find(key);
    return member ? member->number() : 0;
  };
  if (name == "rational") {
    json.require_object({"type", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"});
    return RationalDistortion{.k1 = number("k1"),
                              .k2 = number("k2"),
                              .p1 = number("p1"),
                              .p2 = number("p2"),
                              .k3 = number("k3"),
                              .k4 = number("k4"),
                              .k5 = number("k5"),
                              .k6 = number("k6")};
  }
  if (name != "fisheye") type.fail_unknown("type", name, {"rational", "fisheye"});
  json.require_object({"type", "k1", "k2", "k3", "k4"});
  return FisheyeDistortion{
      .k1 = number("k1"), .k2 = number("k2"), .k3 = number("k3"), .k4 = number("k4")};
}

CalibratedCamera read_calibrated(const JsonReader& json) {
  json.require_object({"name", "type", "position", "direction", "up", "extrinsic", "image", "fx",
                       "fy", "cx", "cy", "distortion"});
  CalibratedCamera camera;
  if (const auto extrinsic = json.find("extrinsic")) {
    for (const char* key : {"position", "direction", "up"}) {
      if (const auto member = json.find(key)) member->fail("must not be combined with extrinsic");
    }
    camera.pose = pose_from_opencv(read_rigid_transform(*extrinsic));
  } else {
    camera.pose = read_pose(json);
  }
  camera.image = read_image_size(json.member("image"));
  camera.fx = json.member("fx").number();
  camera.fy = json.member("fy").number();
  camera.cx = json.member("cx").number();
  camera.cy = json.member("cy").number();
  if (const auto distortion = json.find("distortion"))
    camera.distortion = read_distortion(*distortion);
  return camera;
}

Camera read_kind(const JsonReader& json) {
  json.require_object();
  const JsonReader type = json.member("type");
  const std::string name = type.string();
  if (name == "perspective") return read_perspective(json);
  if (name == "orthographic") return read_orthographic(json);
  if (name == "environment") return read_environment(json);
  if (name == "calibrated") return read_calibrated(json);
  type.fail_unknown("type", name, {"perspective", "orthographic", "environment", "calibrated"});
}

}  // namespace

const char* broken_rotation(const DMat4& transform) {
  // Tolerates calibrations that are stored with only seven digits.
  constexpr double kTolerance = 1e-5;
  const DVec3 x(transform[0]), y(transform[1]), z(transform[2]);
  const auto differ = [](double a, double b) { return !(std::abs(a - b) <= kTolerance); };
  if (differ(glm::dot(x, x), 1) || differ(glm::dot(y, y), 1) || differ(glm::dot(z, z), 1) ||
      differ(glm::dot(x, y), 0) || differ(glm::dot(y, z), 0) || differ(glm::dot(z, x), 0))
    return "must be a rotation in its first three columns and rows: perpendicular, unit length";
  if (glm::dot(glm::cross(x, y), z) < 0) return "must be a rotation, is a reflection";
  return nullptr;
}

Camera read_camera(const JsonReader& json) {
  Camera camera = read_kind(json);
  json.require(validate(camera));
  return camera;
}

}  // namespace microtrace::io
