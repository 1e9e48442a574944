#include "io/gltf/document/variants.hpp"

#include "base/text/named_items.hpp"
#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace microtrace::io::gltf {
namespace {

constexpr const char* kExtensionName = "KHR_materials_variants";

}  // namespace

std::vector<std::string> variant_names(const Asset& asset) {
  const std::optional<Element> root = extension(asset.root(), kExtensionName);
  const JsonValue* variants = root ? root->value->find("variants") : nullptr;
  return variants != nullptr ? names_of(variants->items()) : std::vector<std::string>();
}

void choose_variant(const Asset& asset, const std::string& variant, Model& model) {
  if (variant.empty()) return;
  const std::vector<std::string> names = variant_names(asset);
  if (names.empty())
    throw Error(ErrorKind::usage, asset.file(), "has no variants, so none can be chosen");
  const std::optional<std::size_t> index = find_item(variant, names);
  if (!index) throw Error(ErrorKind::usage, asset.file(), no_such_item("variant", variant, names));
  const auto wanted = static_cast<double>(*index);
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    const Element primitives = asset.element("meshes", i).member("primitives");
    for (std::size_t k = 0; k < model.meshes[i].primitives.size(); ++k) {
      const std::optional<Element> own = extension(primitives.item(k), kExtensionName);
      const JsonValue* mappings = own ? own->value->find("mappings") : nullptr;
      if (mappings == nullptr) continue;
      for (const JsonValue& mapping : mappings->items()) {
        const JsonValue* variants = mapping.find("variants");
        const JsonValue* material = mapping.find("material");
        if (variants == nullptr || material == nullptr) continue;
        const auto is_wanted = [wanted](const JsonValue& item) { return item.number() == wanted; };
        if (!std::ranges::any_of(variants->items(), is_wanted)) continue;
        model.meshes[i].primitives[k].material = index_from(*material);
        break;  // glTF allows only one material for a variant
      }
    }
  }
}

}  // namespace microtrace::io::gltf
