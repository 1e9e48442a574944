#include "io/gltf/check/semantics.hpp"

#include <numbers>
#include <string>

namespace microtrace::io::gltf {
namespace {

void check_perspective(const Asset& asset, const Element& at) {
  if (at.member("yfov").value->number >= std::numbers::pi) {
    asset.fail(at.member("yfov"), "must be below pi; it is an angle in radians");
  }
}

void check_orthographic(Asset& asset, const Element& at) {
  for (const char* key : {"xmag", "ymag"}) {
    const double magnitude = at.member(key).value->number;
    if (magnitude == 0) asset.fail(at.member(key), "must not be 0");
    if (magnitude < 0) asset.warn(at.member(key), "is negative; its magnitude is taken");
  }
}

}  // namespace

void check_cameras(Asset& asset) {
  for (std::size_t i = 0; i < asset.array("cameras").size(); ++i) {
    const Element at = asset.element("cameras", i);
    if (at.value->find("type") == nullptr) continue;  // check_schema has warned
    const std::string& type = at.member("type").value->string;
    const bool perspective = type == "perspective";
    const Element projection = at.member(type);
    const char* other = perspective ? "orthographic" : "perspective";
    if (at.value->find(type) == nullptr) {
      asset.fail(at, "lacks the property \"" + type + "\" that its type names");
    }
    if (at.value->find(other) != nullptr) {
      asset.fail(at.member(other), "stands in a camera of the other type; remove it");
    }
    if (perspective) {
      check_perspective(asset, projection);
    } else {
      check_orthographic(asset, projection);
    }
    const JsonValue* far = projection.value->find("zfar");
    if (far != nullptr && far->number <= projection.member("znear").value->number) {
      asset.fail(projection.member("zfar"), "must be greater than znear");
    }
  }
}

}  // namespace microtrace::io::gltf
