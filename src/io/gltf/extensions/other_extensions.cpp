#include "io/gltf/extensions/extensions.hpp"

#include <numbers>

// The extensions that are not of materials: rules from the JSON schemas that the Khronos Group has
// ratified, and of some that vendors wrote and many use.

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

// Variants of materials.
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

/// A format of images.
constexpr Extension image_row(string_view name, Support support, string_view image_type) {
  return {.name = name,
          .support = support,
          .objects = {{{Place::texture, texture_source}}},
          .image_type = image_type};
}

constexpr Extension list[] = {
    {"EXT_mesh_gpu_instancing", Support::full, {{{Place::node, instancing}}}},
    {"EXT_meshopt_compression",
     Support::full,
     {{{Place::buffer, meshopt_buffer}, {Place::buffer_view, meshopt_view}}}},
    image_row("EXT_texture_avif", Support::none, "image/avif"),
    image_row("EXT_texture_webp", Support::full, "image/webp"),
    {"KHR_animation_pointer", Support::full, {{{Place::animation_target, animation_pointer}}}},
    {"KHR_draco_mesh_compression", Support::full, {{{Place::primitive, draco}}}},
    {"KHR_lights_punctual",
     Support::full,
     {{{Place::root, lights}, {Place::node, light_reference}}}},
    {"KHR_materials_variants",
     Support::full,
     {{{Place::root, variants}, {Place::primitive, mappings}}}},
    {"KHR_mesh_quantization", Support::full},
    {"KHR_meshopt_compression",
     Support::none,
     {{{Place::buffer, meshopt_buffer}, {Place::buffer_view, meshopt_view}}}},
    {"KHR_node_visibility", Support::full, {{{Place::node, visibility}}}},
    image_row("KHR_texture_basisu", Support::full, "image/ktx2"),
    {"KHR_texture_transform", Support::full, {{{Place::texture_info, texture_transform}}}},
    {"KHR_xmp", Support::harmless, {{{Place::anywhere}}}},
    {"KHR_xmp_json_ld",
     Support::harmless,
     {{{Place::root, packets},
       {Place::asset, packet},
       {Place::animation, packet},
       {Place::image, packet},
       {Place::material, packet},
       {Place::mesh, packet},
       {Place::node, packet},
       {Place::scene, packet}}}},
    image_row("MSFT_texture_dds", Support::none, "image/vnd-ms.dds"),
};

}  // namespace

std::span<const Extension> other_extensions() {
  return list;
}

}  // namespace microtrace::io::gltf
