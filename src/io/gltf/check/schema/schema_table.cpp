#include "io/gltf/check/schema/schema.hpp"

#include <array>

// glTF 2.0, section 5, Properties Reference, and the JSON schemas in its appendix A. `extensions`,
// `extras` and `name` may stand in every object and have no row. An empty array is not refused, but
// warned of; "pointer" is an animation's path by KHR_animation_pointer, and the last two media
// types of images are by EXT_texture_webp and KHR_texture_basisu.

namespace microtrace::io::gltf {

namespace {

using std::string_view;

constexpr double component_types[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr double index_types[] = {5121, 5123, 5125};
constexpr double view_targets[] = {34962, 34963};
constexpr double mag_filters[] = {9728, 9729};
constexpr double min_filters[] = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr double wrap_modes[] = {33071, 33648, 10497};
constexpr string_view accessor_types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr string_view alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr string_view camera_types[] = {"perspective", "orthographic"};
constexpr string_view interpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr string_view paths[] = {"translation", "rotation", "scale", "weights", "pointer"};
constexpr string_view image_types[] = {"image/jpeg", "image/png", "image/webp", "image/ktx2"};

constexpr Rule asset_rules[] = {
    {.key = "copyright", .form = Form::string},
    {.key = "generator", .form = Form::string},
    {.key = "version", .form = Form::string, .required = true},
    {.key = "minVersion", .form = Form::string},
};

constexpr Rule sparse_indices_rules[] = {
    index_of("bufferView", "bufferViews", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "componentType", .form = Form::integer, .required = true, .values = index_types},
};
constexpr Rule sparse_values_rules[] = {
    index_of("bufferView", "bufferViews", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
};
constexpr Rule sparse_rules[] = {
    {.key = "count", .form = Form::integer, .required = true, .min = 1},
    {.key = "indices", .form = Form::object, .required = true, .members = sparse_indices_rules},
    {.key = "values", .form = Form::object, .required = true, .members = sparse_values_rules},
};
constexpr Rule accessor_rules[] = {
    index_of("bufferView", "bufferViews"),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "componentType",
     .form = Form::integer,
     .required = true,
     .values = component_types,
     .repair = Repair::drop},
    {.key = "normalized", .form = Form::boolean},
    {.key = "count", .form = Form::integer, .required = true, .min = 1},
    choice("type", accessor_types, true),
    {.key = "max", .form = Form::numbers},
    {.key = "min", .form = Form::numbers},
    {.key = "sparse", .form = Form::object, .members = sparse_rules},
};

constexpr Rule animation_target_rules[] = {
    index_of("node", "nodes"),
    choice("path", paths, true, Repair::keep),
};
constexpr Rule channel_rules[] = {
    {.key = "sampler", .form = Form::integer, .required = true, .min = 0},
    {.key = "target",
     .form = Form::object,
     .required = true,
     .members = animation_target_rules,
     .place = Place::animation_target},
};
constexpr Rule animation_sampler_rules[] = {
    index_of("input", "accessors", true),
    choice("interpolation", interpolations),
    index_of("output", "accessors", true),
};
constexpr Rule animation_rules[] = {
    {.key = "channels", .form = Form::objects, .required = true, .members = channel_rules},
    {.key = "samplers",
     .form = Form::objects,
     .required = true,
     .members = animation_sampler_rules},
};

constexpr Rule buffer_rules[] = {
    {.key = "uri", .form = Form::string},
    {.key = "byteLength", .form = Form::integer, .required = true, .min = 1},
};
constexpr Rule view_rules[] = {
    index_of("buffer", "buffers", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "byteLength", .form = Form::integer, .required = true, .min = 1},
    {.key = "byteStride", .form = Form::integer, .min = 4, .max = 252},
    choice("target", view_targets),
};

constexpr Rule orthographic_rules[] = {
    {.key = "xmag", .form = Form::number, .required = true},
    {.key = "ymag", .form = Form::number, .required = true},
    {.key = "zfar",
     .form = Form::number,
     .required = true,
     .min = 0,
     .above_min = true,
     .repair = Repair::keep},
    {.key = "znear", .form = Form::number, .required = true, .min = 0, .repair = Repair::clamp},
};
constexpr Rule perspective_rules[] = {
    positive("aspectRatio"),
    {.key = "yfov",
     .form = Form::number,
     .required = true,
     .min = 0,
     .above_min = true,
     .repair = Repair::keep},
    positive("zfar"),
    {.key = "znear",
     .form = Form::number,
     .required = true,
     .min = 0,
     .above_min = true,
     .repair = Repair::clamp},
};
constexpr Rule camera_rules[] = {
    {.key = "orthographic", .form = Form::object, .members = orthographic_rules},
    {.key = "perspective", .form = Form::object, .members = perspective_rules},
    choice("type", camera_types, true),
};

constexpr Rule image_rules[] = {
    {.key = "uri", .form = Form::string},
    choice("mimeType", image_types, false, Repair::keep),
    index_of("bufferView", "bufferViews"),
};
constexpr Rule sampler_rules[] = {
    choice("magFilter", mag_filters),
    choice("minFilter", min_filters),
    choice("wrapS", wrap_modes),
    choice("wrapT", wrap_modes),
};
constexpr Rule texture_rules[] = {
    index_of("sampler", "samplers"),
    index_of("source", "images"),
};

constexpr Rule occlusion_texture_rules[] = {
    texture_info_rules[0],
    texture_info_rules[1],
    factor("strength"),
};
constexpr Rule metallic_roughness_rules[] = {
    color("baseColorFactor", 1, 4), texture("baseColorTexture"),         factor("metallicFactor"),
    factor("roughnessFactor"),      texture("metallicRoughnessTexture"),
};
constexpr Rule material_rules[] = {
    {.key = "pbrMetallicRoughness", .form = Form::object, .members = metallic_roughness_rules},
    normal_texture("normalTexture"),
    texture("occlusionTexture", occlusion_texture_rules),
    texture("emissiveTexture"),
    color("emissiveFactor"),
    choice("alphaMode", alpha_modes),
    at_least("alphaCutoff", 0),
    {.key = "doubleSided", .form = Form::boolean},
};

constexpr Rule primitive_rules[] = {
    {.key = "attributes", .form = Form::attributes, .required = true, .target = "accessors"},
    index_of("indices", "accessors"),
    index_of("material", "materials"),
    {.key = "mode", .form = Form::integer, .min = 0, .max = 6},
    {.key = "targets", .form = Form::targets, .target = "accessors"},
};
constexpr Rule mesh_rules[] = {
    {.key = "primitives",
     .form = Form::objects,
     .required = true,
     .members = primitive_rules,
     .place = Place::primitive},
    {.key = "weights", .form = Form::numbers},
};

constexpr Rule node_rules[] = {
    index_of("camera", "cameras"),
    {.key = "children", .form = Form::indices, .target = "nodes"},
    index_of("skin", "skins"),
    vector("matrix", 16),
    index_of("mesh", "meshes"),
    {.key = "rotation",
     .form = Form::numbers,
     .min = -1,
     .max = 1,
     .fewest = 4,
     .most = 4,
     .repair = Repair::keep},
    vector("scale", 3),
    vector("translation", 3),
    {.key = "weights", .form = Form::numbers},
};
constexpr Rule scene_rules[] = {
    {.key = "nodes", .form = Form::indices, .target = "nodes"},
};
constexpr Rule skin_rules[] = {
    index_of("inverseBindMatrices", "accessors"),
    index_of("skeleton", "nodes"),
    {.key = "joints", .form = Form::indices, .required = true, .target = "nodes"},
};

constexpr Rule root_rules[] = {
    {.key = "extensionsUsed", .form = Form::strings},
    {.key = "extensionsRequired", .form = Form::strings},
    {.key = "accessors", .form = Form::objects, .members = accessor_rules},
    {.key = "animations",
     .form = Form::objects,
     .members = animation_rules,
     .place = Place::animation},
    {.key = "asset",
     .form = Form::object,
     .required = true,
     .members = asset_rules,
     .place = Place::asset},
    {.key = "buffers", .form = Form::objects, .members = buffer_rules, .place = Place::buffer},
    {.key = "bufferViews",
     .form = Form::objects,
     .members = view_rules,
     .place = Place::buffer_view},
    {.key = "cameras", .form = Form::objects, .members = camera_rules},
    {.key = "images", .form = Form::objects, .members = image_rules, .place = Place::image},
    {.key = "materials",
     .form = Form::objects,
     .members = material_rules,
     .place = Place::material},
    {.key = "meshes", .form = Form::objects, .members = mesh_rules, .place = Place::mesh},
    {.key = "nodes", .form = Form::objects, .members = node_rules, .place = Place::node},
    {.key = "samplers", .form = Form::objects, .members = sampler_rules},
    index_of("scene", "scenes"),
    {.key = "scenes", .form = Form::objects, .members = scene_rules, .place = Place::scene},
    {.key = "skins", .form = Form::objects, .members = skin_rules},
    {.key = "textures", .form = Form::objects, .members = texture_rules, .place = Place::texture},
};

}  // namespace

std::span<const Rule> gltf_rules() {
  return root_rules;
}

}  // namespace microtrace::io::gltf
