#include "io/gltf/check/texture_infos.hpp"

#include "io/gltf/document/extension.hpp"
#include "io/gltf/extensions/extensions.hpp"

#include <string_view>

namespace microtrace::io::gltf {
namespace {

/// Returns the number of the texture coordinate set. KHR_texture_transform may override the number
/// in the texture info.
double set_of(const JsonValue& info) {
  const JsonValue* transform = extension(info, "KHR_texture_transform");
  const JsonValue* set = transform != nullptr ? transform->find("texCoord") : nullptr;
  if (set == nullptr) set = info.find("texCoord");
  return set != nullptr ? set->number() : 0;
}

/// Collects the texture infos in an object. By check_schema's rules, these are the objects whose
/// key ends in "Texture". Extensions without rules may mean something else by it.
void collect(const JsonValue& object, std::vector<std::pair<std::string, double>>& sets) {
  for (const JsonMember& member : object.members()) {
    if (member.key == "extras" || member.value.kind() != JsonValue::Kind::object) continue;
    if (member.key == "extensions") {
      for (const JsonMember& added : member.value.members()) {
        const Extension* known = find_extension(added.key);
        const bool has_rules = known != nullptr && known->object_in(Place::material) != nullptr;
        if (has_rules) collect(added.value, sets);
      }
      continue;
    }
    const JsonValue* index = member.value.find("index");
    if (member.key.ends_with("Texture") && index != nullptr) {
      sets.emplace_back(member.key, set_of(member.value));
    } else {
      collect(member.value, sets);
    }
  }
}

bool needs_tangents(const JsonValue& material) {
  if (material.find("normalTexture") != nullptr) return false;
  const JsonValue* clearcoat = extension(material, "KHR_materials_clearcoat");
  return extension(material, "KHR_materials_anisotropy") != nullptr ||
         (clearcoat != nullptr && clearcoat->find("clearcoatNormalTexture") != nullptr);
}

/// Returns the set that missing_tangents() chooses, for a material without a normal texture.
double tangent_set(const MaterialTextures& textures) {
  for (const std::string_view key : {"clearcoatNormalTexture", "anisotropyTexture"}) {
    for (const auto& [name, set] : textures.sets) {
      if (name == key) return set;
    }
  }
  return 0;
}

}  // namespace

std::vector<MaterialTextures> texture_infos(const Asset& asset) {
  std::vector<MaterialTextures> result;
  for (const JsonValue& material : asset.array("materials")) {
    MaterialTextures textures;
    collect(material, textures.sets);
    if (needs_tangents(material)) textures.tangent_set = tangent_set(textures);
    result.push_back(std::move(textures));
  }
  return result;
}

}  // namespace microtrace::io::gltf
