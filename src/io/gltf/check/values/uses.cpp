#include "io/gltf/check/values/uses.hpp"

#include "io/gltf/document/properties.hpp"

#include <cstddef>

namespace microtrace::io::gltf {
namespace {

class UseCollector {
 public:
  explicit UseCollector(const Asset& asset)
      : asset_(asset), uses_(asset.array("accessors").size()) {}

  std::vector<AccessorUses> collect() && {
    for (const JsonValue& mesh : asset_.array("meshes")) {
      for (const JsonValue& primitive : mesh.find("primitives")->items()) {
        for (const JsonMember& member : primitive.find("attributes")->members()) {
          attribute(member);
        }
      }
    }
    for (const JsonValue& skin : asset_.array("skins")) {
      if (const JsonValue* matrices = skin.find("inverseBindMatrices")) {
        of(*matrices).matrices = true;
      }
    }
    for (const JsonValue& animation : asset_.array("animations")) this->animation(animation);
    return std::move(uses_);
  }

 private:
  AccessorUses& of(const JsonValue& index) { return uses_[index_from(index)]; }

  void attribute(const JsonMember& member) {
    AccessorUses& uses = of(member.value);
    if (member.key == "NORMAL") uses.normals = true;
    if (member.key == "TANGENT") uses.tangents = true;
    if (member.key.starts_with("COLOR_")) uses.colors = true;
  }

  void animation(const JsonValue& animation) {
    const std::vector<JsonValue>& samplers = animation.find("samplers")->items();
    for (const JsonValue& sampler : samplers) of(*sampler.find("input")).times = true;
    for (const JsonValue& channel : animation.find("channels")->items()) {
      if (channel.find("target")->find("path")->string() != "rotation") continue;
      const JsonValue& sampler = samplers[index_from(*channel.find("sampler"))];
      const JsonValue* interpolation = sampler.find("interpolation");
      AccessorUses& uses = of(*sampler.find("output"));
      uses.quaternions = true;
      uses.spline = interpolation != nullptr && interpolation->string() == "CUBICSPLINE";
    }
  }

  const Asset& asset_;
  std::vector<AccessorUses> uses_;
};

}  // namespace

std::vector<AccessorUses> accessor_uses(const Asset& asset) {
  return UseCollector(asset).collect();
}

}  // namespace microtrace::io::gltf
