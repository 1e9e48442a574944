#include "io/gltf/check/semantics.hpp"

#include <numbers>
#include <string>

namespace microtrace::io::gltf {
namespace {

/// Removes the type of an unusable camera from the asset. check_nodes then removes references to
/// it.
void leave_out(Asset& asset, const Element& camera, const Element& at, const std::string& why) {
  asset.tolerate(at, why + "; the camera is left out");
  asset.drop(camera, {"type"});
}

void check_perspective(Asset& asset, const Element& camera, const Element& at) {
  const JsonValue* far = at.value->find("zfar");
  if (far != nullptr && far->number() <= at.member("znear").value->number()) {
    asset.tolerate(at.member("zfar"), "must be greater than znear; it is ignored");
    asset.drop(at, {"zfar"});
  }
  const Element yfov = at.member("yfov");
  const double angle = yfov.value->number();
  if (angle <= 0) {
    leave_out(asset, camera, yfov, "must be greater than 0");
  } else if (angle >= std::numbers::pi) {
    asset.warn(yfov, "should be below pi, an angle in radians; the camera is left out");
    asset.drop(camera, {"type"});
  }
}

void check_orthographic(Asset& asset, const Element& camera, const Element& at) {
  for (const char* key : {"xmag", "ymag"}) {
    const double magnitude = at.member(key).value->number();
    if (magnitude < 0) asset.warn(at.member(key), "is negative; its absolute value is used");
    if (magnitude != 0) continue;
    return leave_out(asset, camera, at.member(key), "must not be 0");
  }
  if (at.member("zfar").value->number() <= at.member("znear").value->number()) {
    leave_out(asset, camera, at.member("zfar"), "must be greater than znear");
  }
}

void check_camera(Asset& asset, const Element& at) {
  const std::string type = at.member("type").value->string();
  const bool perspective = type == "perspective";
  const char* other = perspective ? "orthographic" : "perspective";
  if (at.value->find(other) != nullptr) {
    asset.tolerate(at.member(other), "belongs to the other type of camera; it is ignored");
    asset.drop(at, {other});
  }
  if (at.value->find(type) == nullptr) {
    return leave_out(asset, at, at, "lacks the property \"" + type + "\" that its type names");
  }
  if (perspective) {
    check_perspective(asset, at, at.member(type));
  } else {
    check_orthographic(asset, at, at.member(type));
  }
}

}  // namespace

void check_cameras(Asset& asset) {
  for (std::size_t i = 0; i < asset.array("cameras").size(); ++i) {
    const Element at = asset.element("cameras", i);
    // The type is missing if check_schema has removed it, with a warning, because it was unknown.
    if (at.value->find("type") != nullptr) check_camera(asset, at);
  }
}

}  // namespace microtrace::io::gltf
