#include "io/gltf/check/schema.hpp"

#include <array>

// glTF 2.0, section 5, Properties Reference, and the JSON schemas in its appendix A. `extensions`,
// `extras` and `name` may stand in every object and have no row. An empty array is not refused, but
// warned of; "pointer" is an animation's path by KHR_animation_pointer, and the last two media
// types of images are by EXT_texture_webp and KHR_texture_basisu.

namespace microtrace::io::gltf {

constexpr Rule texture_info_rules[2] = {
    {.key = "index", .form = Form::index, .required = true, .target = "textures"},
    {.key = "texCoord", .form = Form::integer, .min = 0},
};
constexpr Rule normal_texture_rules[3] = {
    texture_info_rules[0],
    texture_info_rules[1],
    {.key = "scale", .form = Form::number},
};

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
    {.key = "bufferView", .form = Form::index, .required = true, .target = "bufferViews"},
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "componentType",
     .form = Form::integer,
     .required = true,
     .values = index_types,
     .closed = true},
};
constexpr Rule sparse_values_rules[] = {
    {.key = "bufferView", .form = Form::index, .required = true, .target = "bufferViews"},
    {.key = "byteOffset", .form = Form::integer, .min = 0},
};
constexpr Rule sparse_rules[] = {
    {.key = "count", .form = Form::integer, .required = true, .min = 1},
    {.key = "indices", .form = Form::object, .required = true, .members = sparse_indices_rules},
    {.key = "values", .form = Form::object, .required = true, .members = sparse_values_rules},
};
constexpr Rule accessor_rules[] = {
    {.key = "bufferView", .form = Form::index, .target = "bufferViews"},
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "componentType", .form = Form::integer, .required = true, .values = component_types},
    {.key = "normalized", .form = Form::boolean},
    {.key = "count", .form = Form::integer, .required = true, .min = 1},
    {.key = "type", .form = Form::string, .required = true, .strings = accessor_types},
    {.key = "max", .form = Form::numbers, .fewest = 1, .most = 16},
    {.key = "min", .form = Form::numbers, .fewest = 1, .most = 16},
    {.key = "sparse", .form = Form::object, .members = sparse_rules},
};

constexpr Rule animation_target_rules[] = {
    {.key = "node", .form = Form::index, .target = "nodes"},
    {.key = "path", .form = Form::string, .required = true, .strings = paths, .kept = true},
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
    {.key = "input", .form = Form::index, .required = true, .target = "accessors"},
    {.key = "interpolation", .form = Form::string, .strings = interpolations},
    {.key = "output", .form = Form::index, .required = true, .target = "accessors"},
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
    {.key = "buffer", .form = Form::index, .required = true, .target = "buffers"},
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "byteLength", .form = Form::integer, .required = true, .min = 1},
    {.key = "byteStride", .form = Form::integer, .min = 4, .max = 252},
    {.key = "target", .form = Form::integer, .values = view_targets},
};

constexpr Rule orthographic_rules[] = {
    {.key = "xmag", .form = Form::number, .required = true},
    {.key = "ymag", .form = Form::number, .required = true},
    {.key = "zfar", .form = Form::number, .required = true, .min = 0, .above_min = true},
    {.key = "znear", .form = Form::number, .required = true, .min = 0},
};
constexpr Rule perspective_rules[] = {
    {.key = "aspectRatio", .form = Form::number, .min = 0, .above_min = true},
    {.key = "yfov", .form = Form::number, .required = true, .min = 0, .above_min = true},
    {.key = "zfar", .form = Form::number, .min = 0, .above_min = true},
    {.key = "znear", .form = Form::number, .required = true, .min = 0, .above_min = true},
};
constexpr Rule camera_rules[] = {
    {.key = "orthographic", .form = Form::object, .members = orthographic_rules},
    {.key = "perspective", .form = Form::object, .members = perspective_rules},
    {.key = "type", .form = Form::string, .required = true, .strings = camera_types},
};

constexpr Rule image_rules[] = {
    {.key = "uri", .form = Form::string},
    {.key = "mimeType", .form = Form::string, .strings = image_types, .kept = true},
    {.key = "bufferView", .form = Form::index, .target = "bufferViews"},
};
constexpr Rule sampler_rules[] = {
    {.key = "magFilter", .form = Form::integer, .values = mag_filters},
    {.key = "minFilter", .form = Form::integer, .values = min_filters},
    {.key = "wrapS", .form = Form::integer, .values = wrap_modes},
    {.key = "wrapT", .form = Form::integer, .values = wrap_modes},
};
constexpr Rule texture_rules[] = {
    {.key = "sampler", .form = Form::index, .target = "samplers"},
    {.key = "source", .form = Form::index, .target = "images"},
};

constexpr Rule occlusion_texture_rules[] = {
    texture_info_rules[0],
    texture_info_rules[1],
    {.key = "strength", .form = Form::number, .min = 0, .max = 1},
};
constexpr Rule metallic_roughness_rules[] = {
    {.key = "baseColorFactor", .form = Form::numbers, .min = 0, .max = 1, .fewest = 4, .most = 4},
    {.key = "baseColorTexture",
     .form = Form::object,
     .members = texture_info_rules,
     .place = Place::texture_info},
    {.key = "metallicFactor", .form = Form::number, .min = 0, .max = 1},
    {.key = "roughnessFactor", .form = Form::number, .min = 0, .max = 1},
    {.key = "metallicRoughnessTexture",
     .form = Form::object,
     .members = texture_info_rules,
     .place = Place::texture_info},
};
constexpr Rule material_rules[] = {
    {.key = "pbrMetallicRoughness", .form = Form::object, .members = metallic_roughness_rules},
    {.key = "normalTexture",
     .form = Form::object,
     .members = normal_texture_rules,
     .place = Place::texture_info},
    {.key = "occlusionTexture",
     .form = Form::object,
     .members = occlusion_texture_rules,
     .place = Place::texture_info},
    {.key = "emissiveTexture",
     .form = Form::object,
     .members = texture_info_rules,
     .place = Place::texture_info},
    {.key = "emissiveFactor", .form = Form::numbers, .min = 0, .max = 1, .fewest = 3, .most = 3},
    {.key = "alphaMode", .form = Form::string, .strings = alpha_modes},
    {.key = "alphaCutoff", .form = Form::number, .min = 0},
    {.key = "doubleSided", .form = Form::boolean},
};

constexpr Rule primitive_rules[] = {
    {.key = "attributes", .form = Form::attributes, .required = true, .target = "accessors"},
    {.key = "indices", .form = Form::index, .target = "accessors"},
    {.key = "material", .form = Form::index, .target = "materials"},
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
    {.key = "camera", .form = Form::index, .target = "cameras"},
    {.key = "children", .form = Form::indices, .target = "nodes"},
    {.key = "skin", .form = Form::index, .target = "skins"},
    {.key = "matrix", .form = Form::numbers, .fewest = 16, .most = 16},
    {.key = "mesh", .form = Form::index, .target = "meshes"},
    {.key = "rotation", .form = Form::numbers, .min = -1, .max = 1, .fewest = 4, .most = 4},
    {.key = "scale", .form = Form::numbers, .fewest = 3, .most = 3},
    {.key = "translation", .form = Form::numbers, .fewest = 3, .most = 3},
    {.key = "weights", .form = Form::numbers},
};
constexpr Rule scene_rules[] = {
    {.key = "nodes", .form = Form::indices, .target = "nodes"},
};
constexpr Rule skin_rules[] = {
    {.key = "inverseBindMatrices", .form = Form::index, .target = "accessors"},
    {.key = "skeleton", .form = Form::index, .target = "nodes"},
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
    {.key = "scene", .form = Form::index, .target = "scenes"},
    {.key = "scenes", .form = Form::objects, .members = scene_rules, .place = Place::scene},
    {.key = "skins", .form = Form::objects, .members = skin_rules},
    {.key = "textures", .form = Form::objects, .members = texture_rules, .place = Place::texture},
};

}  // namespace

std::span<const Rule> gltf_rules() {
  return root_rules;
}

}  // namespace microtrace::io::gltf
