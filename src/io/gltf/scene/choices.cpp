#include "io/gltf/scene/choices.hpp"

#include "io/gltf/document/properties.hpp"
#include "io/gltf/document/variants.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace microtrace::io::gltf {
namespace {

/// The last time of an animation's keyframes, which glTF requires as the maximum of their accessor
/// (section 3.11).
double end_of(const Asset& asset, const JsonValue& animation) {
  double end = 0;
  const JsonValue* samplers = animation.find("samplers");
  if (samplers == nullptr) return end;
  const std::vector<JsonValue>& accessors = asset.array("accessors");
  for (const JsonValue& sampler : samplers->items()) {
    const JsonValue* input = sampler.find("input");
    if (input == nullptr || !(input->number() >= 0) ||
        !(input->number() < static_cast<double>(accessors.size())))
      continue;
    const JsonValue* most = accessors[index_from(*input)].find("max");
    if (most != nullptr && !most->items().empty()) end = std::max(end, most->items()[0].number());
  }
  return end;
}

}  // namespace

SceneChoices choices_of(const Asset& asset) {
  SceneChoices choices{.variants = variant_names(asset)};
  for (const JsonValue& animation : asset.array("animations"))
    choices.animations.push_back({.name = name_of(animation), .end = end_of(asset, animation)});
  return choices;
}

}  // namespace microtrace::io::gltf
