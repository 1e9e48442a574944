#include "io/gltf/material/material_extensions.hpp"

#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/properties.hpp"
#include "io/gltf/material/textures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace microtrace::io::gltf {
namespace {

Specular specular(const JsonValue& json) {
  return {.factor = number(json, "specularFactor", 1),
          .texture = texture_use(json, "specularTexture"),
          .color = vector(json, "specularColorFactor", Vec3(1)),
          .color_texture = texture_use(json, "specularColorTexture")};
}

Transmission transmission(const JsonValue& json) {
  return {.factor = number(json, "transmissionFactor", 0),
          .texture = texture_use(json, "transmissionTexture")};
}

Volume volume(const JsonValue& json) {
  Volume result{.thickness = number(json, "thicknessFactor", 0),
                .texture = texture_use(json, "thicknessTexture"),
                .attenuation_color = vector(json, "attenuationColor", Vec3(1))};
  // Positive as a number of the file, and so it stays.
  result.attenuation_distance =
      std::max(number(json, "attenuationDistance", result.attenuation_distance),
               std::numeric_limits<float>::min());
  return result;
}

Clearcoat clearcoat(const JsonValue& json) {
  Clearcoat result{.factor = number(json, "clearcoatFactor", 0),
                   .roughness = number(json, "clearcoatRoughnessFactor", 0),
                   .texture = texture_use(json, "clearcoatTexture"),
                   .roughness_texture = texture_use(json, "clearcoatRoughnessTexture"),
                   .normal_texture = texture_use(json, "clearcoatNormalTexture")};
  if (const JsonValue* normal = json.find("clearcoatNormalTexture")) {
    result.normal_scale = number(*normal, "scale", 1);
  }
  return result;
}

Sheen sheen(const JsonValue& json) {
  return {.color = vector(json, "sheenColorFactor", Vec3(0)),
          .roughness = number(json, "sheenRoughnessFactor", 0),
          .color_texture = texture_use(json, "sheenColorTexture"),
          .roughness_texture = texture_use(json, "sheenRoughnessTexture")};
}

Anisotropy anisotropy(const JsonValue& json) {
  const JsonValue* rotation = json.find("anisotropyRotation");
  const double angle = rotation != nullptr ? std::fmod(rotation->number, 2 * std::numbers::pi) : 0;
  return {.strength = number(json, "anisotropyStrength", 0),
          .rotation = finite_float(angle),
          .texture = texture_use(json, "anisotropyTexture")};
}

Iridescence iridescence(const JsonValue& json) {
  const Iridescence standard;
  return {
      .factor = number(json, "iridescenceFactor", 0),
      .ior = number(json, "iridescenceIor", standard.ior),
      .thickness_minimum = number(json, "iridescenceThicknessMinimum", standard.thickness_minimum),
      .thickness_maximum = number(json, "iridescenceThicknessMaximum", standard.thickness_maximum),
      .texture = texture_use(json, "iridescenceTexture"),
      .thickness_texture = texture_use(json, "iridescenceThicknessTexture")};
}

DiffuseTransmission diffuse_transmission(const JsonValue& json) {
  return {.factor = number(json, "diffuseTransmissionFactor", 0),
          .texture = texture_use(json, "diffuseTransmissionTexture"),
          .color = vector(json, "diffuseTransmissionColorFactor", Vec3(1)),
          .color_texture = texture_use(json, "diffuseTransmissionColorTexture")};
}

void read_specular_glossiness(const JsonValue& json, Material& material) {
  material.base_color = vector(json, "diffuseFactor", Vec4(1));
  material.base_color_texture = texture_use(json, "diffuseTexture");
  material.specular_glossiness =
      SpecularGlossiness{.specular = vector(json, "specularFactor", Vec3(1)),
                         .glossiness = number(json, "glossinessFactor", 1),
                         .texture = texture_use(json, "specularGlossinessTexture")};
  // The nearest without it.
  material.metallic_roughness_texture.reset();
  material.metallic = 0;
  material.roughness = 1 - material.specular_glossiness->glossiness;
}

}  // namespace

void read_material_extensions(const JsonValue& json, Material& material) {
  const auto of = [&](std::string_view name) { return extension(json, name); };
  material.unlit = of("KHR_materials_unlit") != nullptr;
  if (material.unlit) {  // nothing but its base color is seen
    material.emissive = Vec3(0);
    material.emissive_texture.reset();
  }
  if (const JsonValue* strength = of("KHR_materials_emissive_strength")) {
    material.emissive *= number(*strength, "emissiveStrength", 1);
  }
  if (const JsonValue* ior = of("KHR_materials_ior")) {
    material.ior = number(*ior, "ior", material.ior);
  }
  if (const JsonValue* dispersion = of("KHR_materials_dispersion")) {
    material.dispersion = number(*dispersion, "dispersion", 0);
  }
  if (const JsonValue* own = of("KHR_materials_specular")) material.specular = specular(*own);
  if (const JsonValue* own = of("KHR_materials_transmission")) {
    material.transmission = transmission(*own);
  }
  if (const JsonValue* own = of("KHR_materials_volume")) {
    material.volume = volume(*own);
  }
  if (const JsonValue* own = of("KHR_materials_clearcoat")) {
    material.clearcoat = clearcoat(*own);
  }
  if (const JsonValue* own = of("KHR_materials_sheen")) {
    material.sheen = sheen(*own);
  }
  if (const JsonValue* own = of("KHR_materials_anisotropy")) {
    material.anisotropy = anisotropy(*own);
  }
  if (const JsonValue* own = of("KHR_materials_iridescence")) {
    material.iridescence = iridescence(*own);
  }
  if (const JsonValue* own = of("KHR_materials_diffuse_transmission")) {
    material.diffuse_transmission = diffuse_transmission(*own);
  }
  // It takes the place of pbrMetallicRoughness, which is for readers that do not know it.
  if (const JsonValue* own = of("KHR_materials_pbrSpecularGlossiness")) {
    read_specular_glossiness(*own, material);
  }
}

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
  leave_out(material.anisotropy, [](const Anisotropy& layer) { return layer.strength; });
  if (material.sheen && material.sheen->color == Vec3(0)) material.sheen.reset();
}

}  // namespace microtrace::io::gltf
