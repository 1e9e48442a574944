#include "base/memory_account.hpp"
#include "io/gltf/animation/animations.hpp"
#include "io/gltf/document/extension.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace microtrace::io::gltf {
namespace {

DVec3 vector_of(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

bool animate_materials(const Asset& asset, const std::vector<std::size_t>& animations) {
  const auto points_to_one = [](const JsonValue& channel) {
    const JsonValue* pointer = extension(*channel.find("target"), "KHR_animation_pointer");
    const JsonValue* text = pointer != nullptr ? pointer->find("pointer") : nullptr;
    return text != nullptr && text->string().starts_with("/materials/");
  };
  return std::ranges::any_of(animations, [&](std::size_t index) {
    return std::ranges::any_of(asset.array("animations")[index].find("channels")->items(),
                               points_to_one);
  });
}

void AnimationPlayer::pose(NodePose& node, Path path, std::vector<double> value) {
  switch (path) {
    case Path::translation:
      node.translation = vector_of(value);
      break;
    case Path::rotation:
      node.rotation = Quaternion(value[0], value[1], value[2], value[3]);
      break;
    case Path::scale:
      node.scale = vector_of(value);
      break;
    case Path::weights:
      node.weights = std::move(value);
      break;
    case Path::visibility:
      node.visible = value[0] != 0;
      break;
    case Path::property:
      break;
  }
}

PosedAsset AnimationPlayer::at(double time) const {
  std::uint64_t numbers = 0;
  for (const Channel& channel : channels_) numbers += channel.keys.width;
  take_memory(channels_.size() * 2 * sizeof(NodePose) + numbers * sizeof(double),
              "the poses of nodes");
  PosedAsset result{.properties = properties_};
  for (const Channel& channel : channels_) {
    std::vector<double> value = value_at(channel.keys, time);
    if (channel.path != Path::property) {
      pose(result.nodes[channel.node], channel.path, std::move(value));
    } else if (std::ranges::all_of(value, [](double x) { return std::isfinite(x); })) {
      set_property(*result.properties, channel.property, value);
    }
  }
  if (result.properties) repair_properties(*result.properties);
  return result;
}

}  // namespace microtrace::io::gltf
