#include "io/gltf/check/schema/schema_rows.hpp"

#include <numbers>

// The JSON schemas of the extensions that the Khronos Group has ratified, and of some that vendors
// wrote and many use. An extension that is not here is not looked into.

namespace microtrace::io::gltf {
namespace {

using std::string_view;

constexpr double quarter_turn = std::numbers::pi / 2;
constexpr string_view lights_array = "/extensions/KHR_lights_punctual/lights";
constexpr string_view variants_array = "/extensions/KHR_materials_variants/variants";
constexpr string_view packets_array = "/extensions/KHR_xmp_json_ld/packets";
constexpr string_view light_types[] = {"directional", "point", "spot"};
constexpr string_view meshopt_modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr string_view meshopt_filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL",
                                           "COLOR"};

constexpr Rule image(string_view key) {
  return index_of(key, "images");
}

// Materials.
constexpr Rule anisotropy[] = {factor("anisotropyStrength"), number("anisotropyRotation"),
                               texture("anisotropyTexture")};
constexpr Rule clearcoat[] = {
    factor("clearcoatFactor"), texture("clearcoatTexture"), factor("clearcoatRoughnessFactor"),
    texture("clearcoatRoughnessTexture"), normal_texture("clearcoatNormalTexture")};
constexpr Rule diffuse_transmission[] = {
    factor("diffuseTransmissionFactor"), texture("diffuseTransmissionTexture"),
    color("diffuseTransmissionColorFactor"), texture("diffuseTransmissionColorTexture")};
constexpr Rule dispersion[] = {at_least("dispersion", 0)};
constexpr Rule emissive_strength[] = {at_least("emissiveStrength", 0)};
// And none between 0 and 1: materials.cpp.
constexpr Rule ior[] = {{.key = "ior", .form = Form::number, .min = 0, .repair = Repair::drop}};
constexpr Rule iridescence[] = {factor("iridescenceFactor"),
                                texture("iridescenceTexture"),
                                at_least("iridescenceIor", 1),
                                at_least("iridescenceThicknessMinimum", 0),
                                at_least("iridescenceThicknessMaximum", 0),
                                texture("iridescenceThicknessTexture")};
constexpr Rule sheen[] = {color("sheenColorFactor"), texture("sheenColorTexture"),
                          factor("sheenRoughnessFactor"), texture("sheenRoughnessTexture")};
constexpr Rule specular[] = {factor("specularFactor"), texture("specularTexture"),
                             color("specularColorFactor", unbounded),
                             texture("specularColorTexture")};
constexpr Rule specular_glossiness[] = {color("diffuseFactor", 1, 4), texture("diffuseTexture"),
                                        color("specularFactor"), factor("glossinessFactor"),
                                        texture("specularGlossinessTexture")};
constexpr Rule transmission[] = {factor("transmissionFactor"), texture("transmissionTexture")};
constexpr Rule volume[] = {at_least("thicknessFactor", 0), texture("thicknessTexture"),
                           positive("attenuationDistance"), color("attenuationColor")};

constexpr Rule variant_rules[] = {{.key = "name", .form = Form::string, .required = true}};
constexpr Rule variants[] = {
    {.key = "variants", .form = Form::objects, .required = true, .members = variant_rules}};
constexpr Rule mapping_rules[] = {
    {.key = "variants", .form = Form::indices, .required = true, .target = variants_array},
    index_of("material", "materials", true),
};
constexpr Rule mappings[] = {
    {.key = "mappings", .form = Form::objects, .required = true, .members = mapping_rules}};

// Textures and images.
constexpr Rule texture_transform[] = {
    vector("offset", 2),
    number("rotation"),
    vector("scale", 2),
    {.key = "texCoord", .form = Form::integer, .min = 0, .repair = Repair::clamp}};
constexpr Rule texture_source[] = {image("source")};

// Lights.
constexpr Rule spot_rules[] = {{.key = "innerConeAngle",
                                .form = Form::number,
                                .min = 0,
                                .max = quarter_turn,
                                .repair = Repair::clamp},
                               {.key = "outerConeAngle",
                                .form = Form::number,
                                .min = 0,
                                .max = quarter_turn,
                                .above_min = true,
                                .repair = Repair::clamp}};
constexpr Rule light_rules[] = {color("color"),
                                at_least("intensity", 0),
                                choice("type", light_types, true, Repair::keep),
                                positive("range"),
                                {.key = "spot", .form = Form::object, .members = spot_rules}};
constexpr Rule lights[] = {
    {.key = "lights", .form = Form::objects, .required = true, .members = light_rules}};
constexpr Rule light_reference[] = {index_of("light", lights_array, true)};

// Geometry and nodes.
constexpr Rule draco[] = {
    index_of("bufferView", "bufferViews", true),
    {.key = "attributes", .form = Form::draco_attributes, .required = true, .min = 0}};
constexpr Rule meshopt_view[] = {
    index_of("buffer", "buffers", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "byteLength", .form = Form::integer, .required = true, .min = 1},
    {.key = "byteStride", .form = Form::integer, .required = true, .min = 1, .max = 256},
    {.key = "count", .form = Form::integer, .required = true, .min = 1},
    choice("mode", meshopt_modes, true, Repair::none),
    choice("filter", meshopt_filters, false, Repair::none)};
constexpr Rule meshopt_buffer[] = {{.key = "fallback", .form = Form::boolean}};
constexpr Rule instancing[] = {{.key = "attributes",
                                .form = Form::instance_attributes,
                                .required = true,
                                .target = "accessors"}};
constexpr Rule visibility[] = {{.key = "visible", .form = Form::boolean}};
constexpr Rule animation_pointer[] = {{.key = "pointer", .form = Form::string, .required = true}};

// Metadata.
constexpr Rule packets[] = {{.key = "packets", .form = Form::anything, .required = true}};
constexpr Rule packet[] = {index_of("packet", packets_array, true)};

constexpr ExtensionRule table[] = {
    {"EXT_mesh_gpu_instancing", Place::node, instancing},
    {"EXT_meshopt_compression", Place::buffer, meshopt_buffer},
    {"EXT_meshopt_compression", Place::buffer_view, meshopt_view},
    {"EXT_texture_avif", Place::texture, texture_source},
    {"EXT_texture_webp", Place::texture, texture_source},
    {"KHR_animation_pointer", Place::animation_target, animation_pointer},
    {"KHR_draco_mesh_compression", Place::primitive, draco},
    {"KHR_lights_punctual", Place::node, light_reference},
    {"KHR_lights_punctual", Place::root, lights},
    {"KHR_materials_anisotropy", Place::material, anisotropy},
    {"KHR_materials_clearcoat", Place::material, clearcoat},
    {"KHR_materials_diffuse_transmission", Place::material, diffuse_transmission},
    {"KHR_materials_dispersion", Place::material, dispersion},
    {"KHR_materials_emissive_strength", Place::material, emissive_strength},
    {"KHR_materials_ior", Place::material, ior},
    {"KHR_materials_iridescence", Place::material, iridescence},
    {"KHR_materials_pbrSpecularGlossiness", Place::material, specular_glossiness},
    {"KHR_materials_sheen", Place::material, sheen},
    {"KHR_materials_specular", Place::material, specular},
    {"KHR_materials_transmission", Place::material, transmission},
    {"KHR_materials_unlit", Place::material, {}},
    {"KHR_materials_variants", Place::primitive, mappings},
    {"KHR_materials_variants", Place::root, variants},
    {"KHR_materials_volume", Place::material, volume},
    {"KHR_meshopt_compression", Place::buffer, meshopt_buffer},
    {"KHR_meshopt_compression", Place::buffer_view, meshopt_view},
    {"KHR_mesh_quantization", Place::nowhere, {}},
    {"KHR_node_visibility", Place::node, visibility},
    {"KHR_texture_basisu", Place::texture, texture_source},
    {"KHR_texture_transform", Place::texture_info, texture_transform},
    {"KHR_xmp_json_ld", Place::animation, packet},
    {"KHR_xmp_json_ld", Place::asset, packet},
    {"KHR_xmp_json_ld", Place::image, packet},
    {"KHR_xmp_json_ld", Place::material, packet},
    {"KHR_xmp_json_ld", Place::mesh, packet},
    {"KHR_xmp_json_ld", Place::node, packet},
    {"KHR_xmp_json_ld", Place::root, packets},
    {"KHR_xmp_json_ld", Place::scene, packet},
    {"MSFT_texture_dds", Place::texture, texture_source},
};

}  // namespace

std::span<const ExtensionRule> extension_rules() {
  return table;
}

}  // namespace microtrace::io::gltf
