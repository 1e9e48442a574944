#include "io/gltf/material/materials.hpp"

#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/properties.hpp"
#include "io/gltf/extensions/extensions.hpp"
#include "io/gltf/extensions/texture_use.hpp"

#include <utility>

namespace microtrace::io::gltf {
namespace {

AlphaMode alpha_mode(const JsonValue& material) {
  const JsonValue* mode = material.find("alphaMode");
  if (mode == nullptr || mode->string() == "OPAQUE") return AlphaMode::opaque;
  return mode->string() == "MASK" ? AlphaMode::mask : AlphaMode::blend;
}

Material standard_material() {
  Material material;
  material.double_sided = false;
  material.metallic = 1;
  return material;
}

void read_metallic_roughness(const JsonValue& pbr, Material& material) {
  material.base_color = vector(pbr, "baseColorFactor", material.base_color);
  material.base_color_texture = texture_use(pbr, "baseColorTexture");
  material.metallic = number(pbr, "metallicFactor", 1);
  material.roughness = number(pbr, "roughnessFactor", 1);
  material.metallic_roughness_texture = texture_use(pbr, "metallicRoughnessTexture");
}

/// Reads a material's extensions, after its other properties.
void read_extensions(const JsonValue& json, Material& material) {
  for (const Extension& known : extensions()) {
    if (known.read_material == nullptr) continue;
    if (const JsonValue* own = extension(json, known.name)) known.read_material(*own, material);
  }
}

/// Removes layers whose factor is 0, and their textures.
void leave_out_unused_layers(Material& material) {
  const auto leave_out = [](auto& layer, auto&& factor) {
    if (layer && factor(*layer) == 0) layer.reset();
  };
  const auto factor = [](const auto& layer) { return layer.factor; };
  leave_out(material.transmission, factor);
  leave_out(material.clearcoat, factor);
  leave_out(material.iridescence, factor);
  leave_out(material.diffuse_transmission, factor);
  leave_out(material.volume, [](const Volume& volume) { return volume.thickness; });
  if (material.volume_scatter && material.volume_scatter->multiscatter_color == Vec3(0))
    material.volume_scatter.reset();
  leave_out(material.anisotropy, [](const Anisotropy& layer) { return layer.strength; });
  if (material.sheen && material.sheen->color == Vec3(0)) material.sheen.reset();
}

Material make_material(const JsonValue& json, UnusedLayers unused) {
  Material material = standard_material();
  material.name = name_of(json);
  if (const JsonValue* pbr = json.find("pbrMetallicRoughness")) {
    read_metallic_roughness(*pbr, material);
  }
  material.alpha_mode = alpha_mode(json);
  material.alpha_cutoff = number(json, "alphaCutoff", 0.5F);
  const JsonValue* double_sided = json.find("doubleSided");
  material.double_sided = double_sided != nullptr && double_sided->boolean();
  material.normal_texture = texture_use(json, "normalTexture");
  if (material.normal_texture)
    material.normal_scale = number(*json.find("normalTexture"), "scale", 1);
  material.occlusion_texture = texture_use(json, "occlusionTexture");
  if (material.occlusion_texture) {
    material.occlusion_strength = number(*json.find("occlusionTexture"), "strength", 1);
  }
  material.emissive = vector(json, "emissiveFactor", material.emissive);
  material.emissive_texture = texture_use(json, "emissiveTexture");
  read_extensions(json, material);
  if (unused == UnusedLayers::left_out) leave_out_unused_layers(material);
  return material;
}

}  // namespace

std::vector<Material> make_materials(const JsonValue& root, UnusedLayers unused) {
  std::vector<Material> materials;
  if (const JsonValue* array = root.find("materials")) {
    for (const JsonValue& json : array->items()) materials.push_back(make_material(json, unused));
  }
  materials.push_back(standard_material());
  return materials;
}

void add_unlit_copies(std::vector<Material>& materials,
                      const std::vector<std::uint32_t>& originals) {
  for (const std::uint32_t original : originals) {
    Material copy = materials[original];
    copy.unlit = true;
    materials.push_back(std::move(copy));
  }
}

}  // namespace microtrace::io::gltf
