#include "io/gltf/check/schema/rule_text.hpp"
#include "io/gltf/check/semantics.hpp"
#include "io/gltf/document/extension.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <unordered_set>

namespace microtrace::io::gltf {
namespace {

double number_or(const JsonValue& object, std::string_view key, double standard) {
  const JsonValue* value = object.find(key);
  return value != nullptr ? value->number() : standard;
}

void check_light(Asset& asset, const Element& at) {
  if (at.member("type").value->string() != "spot") return;
  if (at.value->find("spot") == nullptr) {
    return asset.tolerate(at, "lacks the property \"spot\"; the defaults are used");
  }
  const Element spot = at.member("spot");
  if (spot.value->find("innerConeAngle") == nullptr) return;
  const Element inner = spot.member("innerConeAngle");
  const double outer = number_or(*spot.value, "outerConeAngle", std::numbers::pi / 4);
  if (inner.value->number() < outer) return;
  asset.tolerate(inner, "must be smaller than outerConeAngle; the light's cone has a sharp edge");
  asset.set(inner, std::nextafter(outer, 0));
}

/// Checks the mappings of KHR_materials_variants. Each variant must select only one material.
void check_mappings(Asset& asset, const Element& at) {
  std::unordered_set<double> seen;
  for (std::size_t i = 0; i < at.value->items().size(); ++i) {
    const Element variants = at.item(i).member("variants");
    for (std::size_t k = 0; k < variants.value->items().size(); ++k) {
      if (seen.insert(variants.value->items()[k].number()).second) continue;
      asset.tolerate(variants.item(k), "already has a material in an earlier mapping");
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
    if (ior <= 0 || ior >= 1) continue;
    asset.tolerate(extra->member("ior"),
                   "must be 0 or at least 1, is " + text_of(ior) + "; 1 is used");
    asset.set(extra->member("ior"), 1);
  }
  for (std::size_t i = 0; i < asset.array("meshes").size(); ++i) {
    const Element primitives = asset.element("meshes", i).member("primitives");
    for (std::size_t k = 0; k < primitives.value->items().size(); ++k) {
      const auto variants = extension(primitives.item(k), "KHR_materials_variants");
      if (variants) check_mappings(asset, variants->member("mappings"));
    }
  }
}

void check_lights(Asset& asset) {
  const std::optional<Element> punctual = extension(asset.root(), "KHR_lights_punctual");
  if (!punctual) return;
  const Element lights = punctual->member("lights");
  for (std::size_t i = 0; i < lights.value->items().size(); ++i) check_light(asset, lights.item(i));
}

}  // namespace microtrace::io::gltf
