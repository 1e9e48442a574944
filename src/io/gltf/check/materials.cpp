#include "io/gltf/check/semantics.hpp"
#include "io/gltf/extension.hpp"

#include <numbers>
#include <optional>
#include <string>
#include <unordered_set>

namespace microtrace::io::gltf {
namespace {

double number_or(const JsonValue& object, std::string_view key, double standard) {
  const JsonValue* value = object.find(key);
  return value != nullptr ? value->number : standard;
}

void check_light(const Asset& asset, const Element& at) {
  if (at.member("type").value->string != "spot") return;
  if (at.value->find("spot") == nullptr) {
    asset.fail(at, "lacks the property \"spot\", which a light of that type must have");
  }
  const Element spot = at.member("spot");
  const double inner = number_or(*spot.value, "innerConeAngle", 0);
  const double outer = number_or(*spot.value, "outerConeAngle", std::numbers::pi / 4);
  if (inner >= outer) {
    asset.fail(spot.value->find("innerConeAngle") != nullptr ? spot.member("innerConeAngle") : spot,
               "must be smaller than outerConeAngle");
  }
}

/// KHR_materials_variants: a variant picks one material.
void check_mappings(Asset& asset, const Element& at) {
  std::unordered_set<double> seen;
  for (std::size_t i = 0; i < at.value->items.size(); ++i) {
    const Element variants = at.item(i).member("variants");
    for (std::size_t k = 0; k < variants.value->items.size(); ++k) {
      if (seen.insert(variants.value->items[k].number).second) continue;
      asset.warn(variants.item(k), "has a material in an earlier mapping already");
    }
  }
}

}  // namespace

void check_materials(Asset& asset) {
  for (std::size_t i = 0; i < asset.array("materials").size(); ++i) {
    const Element at = asset.element("materials", i);
    const std::optional<Element> extra = extension(at, "KHR_materials_ior");
    if (!extra) continue;
    const double ior = number_or(*extra->value, "ior", 1.5);
    if (ior > 0 && ior < 1) {
      asset.fail(extra->member("ior"), "must be 0 or at least 1, is " + std::to_string(ior));
    }
  }
  for (std::size_t i = 0; i < asset.array("meshes").size(); ++i) {
    const Element primitives = asset.element("meshes", i).member("primitives");
    for (std::size_t k = 0; k < primitives.value->items.size(); ++k) {
      const auto variants = extension(primitives.item(k), "KHR_materials_variants");
      if (variants) check_mappings(asset, variants->member("mappings"));
    }
  }
}

void check_lights(Asset& asset) {
  const std::optional<Element> punctual = extension(asset.root(), "KHR_lights_punctual");
  if (!punctual) return;
  const Element lights = punctual->member("lights");
  for (std::size_t i = 0; i < lights.value->items.size(); ++i) check_light(asset, lights.item(i));
}

}  // namespace microtrace::io::gltf
