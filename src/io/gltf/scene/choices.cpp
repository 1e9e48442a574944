#include "io/gltf/scene/choices.hpp"

#include "io/gltf/document/extension.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

namespace microtrace::io::gltf {
namespace {

std::string name_or_empty(const JsonValue& value) {
  const JsonValue* name = value.find("name");
  return name != nullptr ? name->string() : std::string();
}

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
    const JsonValue* most = accessors[static_cast<std::size_t>(input->number())].find("max");
    if (most != nullptr && !most->items().empty()) end = std::max(end, most->items()[0].number());
  }
  return end;
}

}  // namespace

SceneChoices choices_of(const Asset& asset) {
  SceneChoices choices;
  if (const std::optional<Element> root = extension(asset.root(), "KHR_materials_variants")) {
    if (const JsonValue* variants = root->value->find("variants")) {
      for (const JsonValue& variant : variants->items())
        choices.variants.push_back(name_or_empty(variant));
    }
  }
  for (const JsonValue& animation : asset.array("animations"))
    choices.animations.push_back(
        {.name = name_or_empty(animation), .end = end_of(asset, animation)});
  return choices;
}

}  // namespace microtrace::io::gltf
