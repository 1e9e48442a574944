#include "io/gltf/extensions/extensions.hpp"

#include <numbers>

// All other extensions. Their rules come from JSON schemas that the Khronos Group has ratified, and
// from some common vendor extensions.

namespace microtrace::io::gltf {
namespace {

using std::string_view;

constexpr double kQuarterTurn = std::numbers::pi / 2;
constexpr string_view kLightsArray = "/extensions/KHR_lights_punctual/lights";
constexpr string_view kVariantsArray = "/extensions/KHR_materials_variants/variants";
constexpr string_view kPacketsArray = "/extensions/KHR_xmp_json_ld/packets";
constexpr string_view kLightTypes[] = {"directional", "point", "spot"};
constexpr string_view kMeshoptModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr string_view kMeshoptFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL",
                                           "COLOR"};

constexpr Rule image(string_view key) {
  return index_of(key, "images");
}

// Variants of materials
constexpr Rule kVariantRules[] = {{.key = "name", .form = Form::string, .required = true}};
constexpr Rule kVariants[] = {
    {.key = "variants", .form = Form::objects, .required = true, .members = kVariantRules}};
constexpr Rule kMappingRules[] = {
    {.key = "variants", .form = Form::indices, .required = true, .target = kVariantsArray},
    index_of("material", "materials", true),
};
constexpr Rule kMappings[] = {
    {.key = "mappings", .form = Form::objects, .required = true, .members = kMappingRules}};

// Textures and images
constexpr Rule kTextureTransform[] = {
    vector("offset", 2),
    number("rotation"),
    vector("scale", 2),
    {.key = "texCoord", .form = Form::integer, .min = 0, .repair = Repair::clamp}};
constexpr Rule kTextureSource[] = {image("source")};

// Lights
constexpr Rule kSpotRules[] = {{.key = "innerConeAngle",
                                .form = Form::number,
                                .min = 0,
                                .max = kQuarterTurn,
                                .repair = Repair::clamp},
                               {.key = "outerConeAngle",
                                .form = Form::number,
                                .min = 0,
                                .max = kQuarterTurn,
                                .above_min = true,
                                .repair = Repair::clamp}};
constexpr Rule kLightRules[] = {color("color"),
                                at_least("intensity", 0),
                                choice("type", kLightTypes, true, Repair::keep),
                                positive("range"),
                                {.key = "spot", .form = Form::object, .members = kSpotRules}};
constexpr Rule kLights[] = {
    {.key = "lights", .form = Form::objects, .required = true, .members = kLightRules}};
constexpr Rule kLightReference[] = {index_of("light", kLightsArray, true)};

// Geometry and nodes
constexpr Rule kDraco[] = {
    index_of("bufferView", "bufferViews", true),
    {.key = "attributes", .form = Form::draco_attributes, .required = true, .min = 0}};
constexpr Rule kMeshoptView[] = {
    index_of("buffer", "buffers", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "byteLength", .form = Form::integer, .required = true, .min = 1},
    {.key = "byteStride", .form = Form::integer, .required = true, .min = 1, .max = 256},
    {.key = "count", .form = Form::integer, .required = true, .min = 1},
    choice("mode", kMeshoptModes, true, Repair::none),
    choice("filter", kMeshoptFilters, false, Repair::none)};
constexpr Rule kMeshoptBuffer[] = {{.key = "fallback", .form = Form::boolean}};
constexpr Rule kInstancing[] = {{.key = "attributes",
                                 .form = Form::instance_attributes,
                                 .required = true,
                                 .target = "accessors"}};
constexpr Rule kVisibility[] = {{.key = "visible", .form = Form::boolean}};
constexpr Rule kAnimationPointer[] = {{.key = "pointer", .form = Form::string, .required = true}};

// Metadata
constexpr Rule kPackets[] = {{.key = "packets", .form = Form::anything, .required = true}};
constexpr Rule kPacket[] = {index_of("packet", kPacketsArray, true)};

/// Returns the row of an extension that adds an image format.
constexpr Extension image_row(string_view name, Support support, string_view image_type) {
  return {.name = name,
          .support = support,
          .objects = {{{Place::texture, kTextureSource}}},
          .image_type = image_type};
}

constexpr Extension meshopt_row(string_view name) {
  return {
      name, Support::full, {{{Place::buffer, kMeshoptBuffer}, {Place::buffer_view, kMeshoptView}}}};
}

/// Returns the row of an extension without effect on pictures.
constexpr Extension harmless_row(string_view name) {
  return {.name = name, .support = Support::harmless, .objects = {{{Place::anywhere}}}};
}

constexpr Extension kList[] = {
    harmless_row("AGI_articulations"),
    harmless_row("BLENDER_physics"),
    harmless_row("CESIUM_RTC"),
    harmless_row("CESIUM_primitive_outline"),
    harmless_row("EXT_instance_features"),
    harmless_row("EXT_mesh_features"),
    {"EXT_mesh_gpu_instancing", Support::full, {{{Place::node, kInstancing}}}},
    harmless_row("EXT_mesh_manifold"),
    harmless_row("EXT_mesh_primitive_edge_visibility"),
    {"EXT_mesh_primitive_restart", Support::full},
    meshopt_row("EXT_meshopt_compression"),
    harmless_row("EXT_structural_metadata"),
    image_row("EXT_texture_avif", Support::none, "image/avif"),
    image_row("EXT_texture_webp", Support::full, "image/webp"),
    harmless_row("FB_geometry_metadata"),
    harmless_row("FB_ngon_encoding"),
    harmless_row("GODOT_single_root"),
    {"KHR_animation_pointer", Support::full, {{{Place::animation_target, kAnimationPointer}}}},
    harmless_row("KHR_audio"),
    harmless_row("KHR_audio_emitter"),
    {"KHR_draco_mesh_compression", Support::full, {{{Place::primitive, kDraco}}}},
    harmless_row("KHR_implicit_shapes"),
    harmless_row("KHR_interactivity"),
    {"KHR_lights_punctual",
     Support::full,
     {{{Place::root, kLights}, {Place::node, kLightReference}}}},
    {"KHR_materials_variants",
     Support::full,
     {{{Place::root, kVariants}, {Place::primitive, kMappings}}}},
    {"KHR_mesh_quantization", Support::full},
    meshopt_row("KHR_meshopt_compression"),
    harmless_row("KHR_node_hoverability"),
    harmless_row("KHR_node_selectability"),
    {"KHR_node_visibility", Support::full, {{{Place::node, kVisibility}}}},
    harmless_row("KHR_physics_rigid_bodies"),
    image_row("KHR_texture_basisu", Support::full, "image/ktx2"),
    {"KHR_texture_transform", Support::full, {{{Place::texture_info, kTextureTransform}}}},
    harmless_row("KHR_xmp"),
    {"KHR_xmp_json_ld",
     Support::harmless,
     {{{Place::root, kPackets},
       {Place::asset, kPacket},
       {Place::animation, kPacket},
       {Place::image, kPacket},
       {Place::material, kPacket},
       {Place::mesh, kPacket},
       {Place::node, kPacket},
       {Place::scene, kPacket}}}},
    harmless_row("MOZ_hubs_components"),
    harmless_row("MSFT_audio_emitter"),
    harmless_row("MSFT_lod"),
    image_row("MSFT_texture_dds", Support::none, "image/vnd-ms.dds"),
    harmless_row("OMI_audio_emitter"),
    harmless_row("OMI_physics_body"),
    harmless_row("OMI_physics_joint"),
    harmless_row("OMI_physics_shape"),
    harmless_row("VRM"),
    harmless_row("VRMC_node_constraint"),
    harmless_row("VRMC_springBone"),
    harmless_row("VRMC_vrm"),
};

}  // namespace

std::span<const Extension> other_extensions() {
  return kList;
}

}  // namespace microtrace::io::gltf
