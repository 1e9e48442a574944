#include "io/gltf/bytes/meshopt_extension.hpp"
#include "io/gltf/check/semantics.hpp"
#include "io/gltf/document/element_types.hpp"
#include "io/gltf/document/extension.hpp"

#include <cmath>
#include <string>

namespace microtrace::io::gltf {
namespace {

constexpr double kElementArrayBuffer = 34963;

/// Each of the two extensions excludes the other one in the same buffer or view.
void check_compression(Asset& asset, const Element& at) {
  if (!extension(at, kExtMeshopt) || !extension(at, kKhrMeshopt)) return;
  asset.tolerate(at.member("extensions").member(kExtMeshopt),
                 "must not be combined with KHR_meshopt_compression; it is ignored");
}

/// Accepts empty buffers and views: gltfpack writes an empty buffer for an asset without geometry.
void check_length(Asset& asset, const Element& at) {
  if (at.member("byteLength").value->number() == 0)
    asset.tolerate(at.member("byteLength"), "must be an integer of at least 1, is 0");
}

void check_view(Asset& asset, const Element& at) {
  const JsonValue* stride = at.value->find("byteStride");
  if (stride == nullptr) return;
  if (stride->number() == 0) {
    asset.tolerate(at.member("byteStride"), "must not be 0; the data is read as tightly packed");
    asset.drop(at, {"byteStride"});
    return;
  }
  if (stride->number() < 4 || stride->number() > 252 || std::fmod(stride->number(), 4) != 0)
    asset.tolerate(at.member("byteStride"), "must be a multiple of 4 between 4 and 252");
  const double length = at.member("byteLength").value->number();
  if (length > 0 && stride->number() > length) {
    asset.fail(at.member("byteStride"), "is greater than byteLength");
  }
  const JsonValue* target = at.value->find("target");
  if (target != nullptr && target->number() == kElementArrayBuffer) {
    asset.tolerate(at.member("byteStride"), "is not allowed for indices, which are tightly packed");
  }
}

void check_bounds(Asset& asset, const Element& at) {
  const std::size_t expected = component_count(element_type(at.member("type").value->string()));
  for (const char* key : {"min", "max"}) {
    const JsonValue* bounds = at.value->find(key);
    if (bounds == nullptr || bounds->items().size() == expected) continue;
    asset.tolerate(at.member(key), "must have " + std::to_string(expected) + " items, has " +
                                       std::to_string(bounds->items().size()) + "; it is ignored");
    asset.drop(at, {key});
  }
}

void check_accessor(Asset& asset, const Element& at) {
  if (at.value->find("componentType") == nullptr || at.value->find("type") == nullptr) {
    return;  // check_schema has warned about an unknown type
  }
  check_bounds(asset, at);
  if (at.value->find("count")->number() == 0)
    asset.tolerate(at.member("count"), "must be at least 1; an empty accessor has no data");
  const JsonValue* component = at.value->find("componentType");
  const JsonValue* normalized = at.value->find("normalized");
  if (at.value->find("byteOffset") != nullptr && at.value->find("bufferView") == nullptr) {
    asset.tolerate(at.member("byteOffset"), "has no effect: the accessor has no bufferView");
  }
  const bool can_be_normalized = component->number() != kFloat32 && component->number() != kUint32;
  if (normalized != nullptr && normalized->boolean() && !can_be_normalized) {
    asset.tolerate(at.member("normalized"),
                   "has no effect: only integers of 8 or 16 bits can be normalized");
    asset.drop(at, {"normalized"});
  }
}

}  // namespace

void check_storage(Asset& asset) {
  for (std::size_t i = 0; i < asset.array("buffers").size(); ++i) {
    check_compression(asset, asset.element("buffers", i));
    check_length(asset, asset.element("buffers", i));
  }
  for (std::size_t i = 0; i < asset.array("bufferViews").size(); ++i) {
    check_compression(asset, asset.element("bufferViews", i));
    check_length(asset, asset.element("bufferViews", i));
    check_view(asset, asset.element("bufferViews", i));
  }
  for (std::size_t i = 0; i < asset.array("accessors").size(); ++i) {
    check_accessor(asset, asset.element("accessors", i));
  }
}

}  // namespace microtrace::io::gltf
