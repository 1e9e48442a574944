#include "io/gltf/document/variants.hpp"

#include "base/printable.hpp"
#include "io/gltf/document/extension.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace microtrace::io::gltf {
namespace {

constexpr const char* kExtensionName = "KHR_materials_variants";

std::size_t index_of(const Asset& asset, const std::string& wanted) {
  const std::optional<Element> root = extension(asset.root(), kExtensionName);
  const JsonValue* variants = root ? root->value->find("variants") : nullptr;
  if (variants == nullptr) {
    throw Error(ErrorKind::usage, asset.file(), "has no variants; leave out --variant");
  }
  std::string names;
  for (std::size_t i = 0; i < variants->items().size(); ++i) {
    const JsonValue* name = variants->items()[i].find("name");
    if (name != nullptr && name->string() == wanted) return i;
    names += (i == 0 ? "" : ", ") + std::to_string(i);
    if (name != nullptr) names += " (" + printable(name->string()) + ")";
  }
  for (std::size_t i = 0; i < variants->items().size(); ++i) {
    if (std::to_string(i) == wanted) return i;
  }
  throw Error(ErrorKind::usage, asset.file(),
              "there is no variant " + in_quotes(wanted) + "; the asset has " + names);
}

}  // namespace

void choose_variant(const Asset& asset, const std::string& variant, Model& model) {
  if (variant.empty()) return;
  const auto wanted = static_cast<double>(index_of(asset, variant));
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
        model.meshes[i].primitives[k].material = static_cast<std::size_t>(material->number());
        break;  // glTF allows only one material for a variant
      }
    }
  }
}

}  // namespace microtrace::io::gltf
