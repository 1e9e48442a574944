#include "io/gltf/document/properties.hpp"
#include "io/gltf/extensions/extensions.hpp"
#include "io/gltf/extensions/texture_use.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

// Each material extension has three parts: rules from the JSON schema that the Khronos Group has
// ratified (KHR_materials_volume_scatter: drafted), a reader, and a row in the list below.

namespace microtrace::io::gltf {
namespace {

constexpr Rule kAnisotropyRules[] = {factor("anisotropyStrength"), number("anisotropyRotation"),
                                     texture("anisotropyTexture")};
Anisotropy anisotropy(const JsonValue& json) {
  const JsonValue* rotation = json.find("anisotropyRotation");
  const double angle =
      rotation != nullptr ? std::fmod(rotation->number(), 2 * std::numbers::pi) : 0;
  return {.strength = number(json, "anisotropyStrength", 0),
          .rotation = finite_float(angle),
          .texture = texture_use(json, "anisotropyTexture")};
}

constexpr Rule kClearcoatRules[] = {
    factor("clearcoatFactor"), texture("clearcoatTexture"), factor("clearcoatRoughnessFactor"),
    texture("clearcoatRoughnessTexture"), normal_texture("clearcoatNormalTexture")};
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

constexpr Rule kDiffuseTransmissionRules[] = {
    factor("diffuseTransmissionFactor"), texture("diffuseTransmissionTexture"),
    color("diffuseTransmissionColorFactor"), texture("diffuseTransmissionColorTexture")};
DiffuseTransmission diffuse_transmission(const JsonValue& json) {
  return {.factor = number(json, "diffuseTransmissionFactor", 0),
          .texture = texture_use(json, "diffuseTransmissionTexture"),
          .color = vector(json, "diffuseTransmissionColorFactor", Vec3(1)),
          .color_texture = texture_use(json, "diffuseTransmissionColorTexture")};
}

constexpr Rule kDispersionRules[] = {at_least("dispersion", 0)};
void read_dispersion(const JsonValue& json, Material& material) {
  material.dispersion = number(json, "dispersion", 0);
}

constexpr Rule kEmissiveStrengthRules[] = {at_least("emissiveStrength", 0)};
void read_emissive_strength(const JsonValue& json, Material& material) {
  material.emissive *= number(json, "emissiveStrength", 1);
}

// check_materials replaces values between 0 and 1 by 1.
constexpr Rule kIorRules[] = {
    {.key = "ior", .form = Form::number, .min = 0, .repair = Repair::drop}};
void read_ior(const JsonValue& json, Material& material) {
  material.ior = number(json, "ior", material.ior);
}

constexpr Rule kIridescenceRules[] = {factor("iridescenceFactor"),
                                      texture("iridescenceTexture"),
                                      at_least("iridescenceIor", 1),
                                      at_least("iridescenceThicknessMinimum", 0),
                                      at_least("iridescenceThicknessMaximum", 0),
                                      texture("iridescenceThicknessTexture")};
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

constexpr Rule kSpecularGlossinessRules[] = {
    color("diffuseFactor", 1, 4), texture("diffuseTexture"), color("specularFactor"),
    factor("glossinessFactor"), texture("specularGlossinessTexture")};
/// Overrides pbrMetallicRoughness, which is a fallback for readers without this extension.
void read_specular_glossiness(const JsonValue& json, Material& material) {
  material.base_color = vector(json, "diffuseFactor", Vec4(1));
  material.base_color_texture = texture_use(json, "diffuseTexture");
  material.specular_glossiness =
      SpecularGlossiness{.specular = vector(json, "specularFactor", Vec3(1)),
                         .glossiness = number(json, "glossinessFactor", 1),
                         .texture = texture_use(json, "specularGlossinessTexture")};
  // Approximates the material by the metallic-roughness model.
  material.metallic_roughness_texture.reset();
  material.metallic = 0;
  material.roughness = 1 - material.specular_glossiness->glossiness;
}

constexpr Rule kSheenRules[] = {color("sheenColorFactor"), texture("sheenColorTexture"),
                                factor("sheenRoughnessFactor"), texture("sheenRoughnessTexture")};
Sheen sheen(const JsonValue& json) {
  return {.color = vector(json, "sheenColorFactor", Vec3(0)),
          .roughness = number(json, "sheenRoughnessFactor", 0),
          .color_texture = texture_use(json, "sheenColorTexture"),
          .roughness_texture = texture_use(json, "sheenRoughnessTexture")};
}

constexpr Rule kSpecularRules[] = {factor("specularFactor"), texture("specularTexture"),
                                   color("specularColorFactor", kUnbounded),
                                   texture("specularColorTexture")};
Specular specular(const JsonValue& json) {
  return {.factor = number(json, "specularFactor", 1),
          .texture = texture_use(json, "specularTexture"),
          .color = vector(json, "specularColorFactor", Vec3(1)),
          .color_texture = texture_use(json, "specularColorTexture")};
}

constexpr Rule kTransmissionRules[] = {factor("transmissionFactor"),
                                       texture("transmissionTexture")};
Transmission transmission(const JsonValue& json) {
  return {.factor = number(json, "transmissionFactor", 0),
          .texture = texture_use(json, "transmissionTexture")};
}

/// Reads an unlit material, which shows only its base color.
void read_unlit(const JsonValue&, Material& material) {
  material.unlit = true;
  material.emissive = Vec3(0);
  material.emissive_texture.reset();
}

constexpr Rule kVolumeRules[] = {at_least("thicknessFactor", 0), texture("thicknessTexture"),
                                 positive("attenuationDistance"), color("attenuationColor")};
Volume volume(const JsonValue& json) {
  Volume result{.thickness = number(json, "thicknessFactor", 0),
                .texture = texture_use(json, "thicknessTexture"),
                .attenuation_color = vector(json, "attenuationColor", Vec3(1))};
  // A positive distance in the file must not round to 0 in float32.
  result.attenuation_distance =
      std::max(number(json, "attenuationDistance", result.attenuation_distance),
               std::numeric_limits<float>::min());
  return result;
}

constexpr Rule kVolumeScatterRules[] = {color("multiscatterColor"),
                                        {.key = "scatterAnisotropy",
                                         .form = Form::number,
                                         .min = -1,
                                         .max = 1,
                                         .repair = Repair::clamp}};
VolumeScatter volume_scatter(const JsonValue& json) {
  return {.multiscatter_color = vector(json, "multiscatterColor", Vec3(0)),
          .anisotropy = number(json, "scatterAnisotropy", 0)};
}

/// Reads an optional layer of the material.
template <auto layer, auto read>
void read_layer(const JsonValue& json, Material& material) {
  material.*layer = read(json);
}

constexpr Extension row(std::string_view name, std::span<const Rule> rules,
                        void (*read)(const JsonValue&, Material&)) {
  return {.name = name,
          .support = Support::full,
          .objects = {{{Place::material, rules}}},
          .read_material = read};
}

/// The material extensions, sorted by name. They can be read in any order, because each changes its
/// own properties. The exception is emission: one extension scales it and another removes it.
constexpr Extension kList[] = {
    row("KHR_materials_anisotropy", kAnisotropyRules,
        read_layer<&Material::anisotropy, anisotropy>),
    row("KHR_materials_clearcoat", kClearcoatRules, read_layer<&Material::clearcoat, clearcoat>),
    row("KHR_materials_diffuse_transmission", kDiffuseTransmissionRules,
        read_layer<&Material::diffuse_transmission, diffuse_transmission>),
    row("KHR_materials_dispersion", kDispersionRules, read_dispersion),
    row("KHR_materials_emissive_strength", kEmissiveStrengthRules, read_emissive_strength),
    row("KHR_materials_ior", kIorRules, read_ior),
    row("KHR_materials_iridescence", kIridescenceRules,
        read_layer<&Material::iridescence, iridescence>),
    row("KHR_materials_pbrSpecularGlossiness", kSpecularGlossinessRules, read_specular_glossiness),
    row("KHR_materials_sheen", kSheenRules, read_layer<&Material::sheen, sheen>),
    row("KHR_materials_specular", kSpecularRules, read_layer<&Material::specular, specular>),
    row("KHR_materials_transmission", kTransmissionRules,
        read_layer<&Material::transmission, transmission>),
    row("KHR_materials_unlit", {}, read_unlit),
    row("KHR_materials_volume", kVolumeRules, read_layer<&Material::volume, volume>),
    row("KHR_materials_volume_scatter", kVolumeScatterRules,
        read_layer<&Material::volume_scatter, volume_scatter>),
};

}  // namespace

std::span<const Extension> material_extensions() {
  return kList;
}

}  // namespace microtrace::io::gltf
