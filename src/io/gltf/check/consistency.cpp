#include "io/gltf/check/consistency.hpp"

#include "io/gltf/uri.hpp"

#include <cmath>
#include <cstddef>
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

/// A camera whose type check_schema did not know.
void drop_cameras_without_type(Asset& asset) {
  for (std::size_t i = 0; i < asset.array("nodes").size(); ++i) {
    const Element at = asset.element("nodes", i);
    const JsonValue* index = at.value->find("camera");
    if (index == nullptr) continue;
    const JsonValue& camera = asset.array("cameras")[static_cast<std::size_t>(index->number)];
    if (camera.find("type") == nullptr) Asset::drop(at, "camera");
  }
}

void check_strides(const Asset& asset) {
  for (std::size_t i = 0; i < asset.array("bufferViews").size(); ++i) {
    const Element at = asset.element("bufferViews", i);
    const JsonValue* stride = at.value->find("byteStride");
    if (stride == nullptr) continue;
    if (std::fmod(stride->number, 4) != 0) {
      asset.fail(at.member("byteStride"), "must be a multiple of 4");
    }
    if (stride->number > at.member("byteLength").value->number) {
      asset.fail(at.member("byteStride"), "is greater than byteLength");
    }
  }
}

std::size_t components(const std::string& type) {
  if (type == "SCALAR") return 1;
  const auto n = static_cast<std::size_t>(type.back() - '0');
  return type.starts_with("MAT") ? n * n : n;
}

void check_bounds(const Asset& asset) {
  for (std::size_t i = 0; i < asset.array("accessors").size(); ++i) {
    const Element at = asset.element("accessors", i);
    if (at.value->find("type") == nullptr) continue;  // check_schema has warned
    const std::size_t expected = components(at.member("type").value->string);
    for (const char* key : {"min", "max"}) {
      const JsonValue* bounds = at.value->find(key);
      if (bounds == nullptr || bounds->items.size() == expected) continue;
      asset.fail(at.member(key), "must have " + std::to_string(expected) + " items, has " +
                                     std::to_string(bounds->items.size()));
    }
  }
}

void check_images(const Asset& asset) {
  for (std::size_t i = 0; i < asset.array("images").size(); ++i) {
    const Element at = asset.element("images", i);
    const JsonValue* uri = at.value->find("uri");
    if ((uri == nullptr) == (at.value->find("bufferView") == nullptr)) {
      asset.fail(at, "must have either a uri or a bufferView");
    }
    if (uri == nullptr) continue;
    if (is_data_uri(uri->string)) {
      if (!split_data_uri(uri->string)) {
        asset.fail(at.member("uri"), "is no data URI of the form data:TYPE;base64,DATA");
      }
    } else if (const RelativePath path = relative_path(uri->string); !path.refusal.empty()) {
      asset.fail(at.member("uri"), path.refusal);
    }
  }
}

void check_animations(const Asset& asset) {
  for (std::size_t i = 0; i < asset.array("animations").size(); ++i) {
    const Element at = asset.element("animations", i);
    const std::size_t samplers = at.member("samplers").value->items.size();
    const Element channels = at.member("channels");
    for (std::size_t k = 0; k < channels.value->items.size(); ++k) {
      const Element sampler = channels.item(k).member("sampler");
      if (sampler.value->number >= static_cast<double>(samplers)) {
        asset.fail(sampler, "names a sampler that the animation does not have");
      }
    }
  }
}

}  // namespace

void check_consistency(Asset& asset) {
  check_cameras(asset);
  drop_cameras_without_type(asset);
  check_strides(asset);
  check_bounds(asset);
  check_images(asset);
  check_animations(asset);
}

}  // namespace microtrace::io::gltf
