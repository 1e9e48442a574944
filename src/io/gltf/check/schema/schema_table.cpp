#include "io/gltf/check/schema/schema.hpp"

#include <array>

// Source: glTF 2.0, section 5, Properties Reference, and the JSON schemas in its appendix A.
// `extensions`, `extras` and `name` are allowed in every object and have no row. Empty arrays cause
// a warning, not an error. "pointer" is the animation path of KHR_animation_pointer. The last two
// media types of images belong to EXT_texture_webp and KHR_texture_basisu.

namespace microtrace::io::gltf {

namespace {

using std::string_view;

constexpr double kComponentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr double kIndexTypes[] = {5121, 5123, 5125};
constexpr double kViewTargets[] = {34962, 34963};
constexpr double kMagFilters[] = {9728, 9729};
constexpr double kMinFilters[] = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr double kWrapModes[] = {33071, 33648, 10497};
constexpr string_view kAccessorTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr string_view kCameraTypes[] = {"perspective", "orthographic"};
constexpr string_view kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr string_view kPaths[] = {"translation", "rotation", "scale", "weights", "pointer"};
constexpr string_view kImageTypes[] = {"image/jpeg", "image/png", "image/webp", "image/ktx2"};

constexpr Rule kAssetRules[] = {
    {.key = "copyright", .form = Form::string},
    {.key = "generator", .form = Form::string},
    {.key = "version", .form = Form::string, .required = true},
    {.key = "minVersion", .form = Form::string},
};

constexpr Rule kSparseIndicesRules[] = {
    index_of("bufferView", "bufferViews", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "componentType", .form = Form::integer, .required = true, .values = kIndexTypes},
};
constexpr Rule kSparseValuesRules[] = {
    index_of("bufferView", "bufferViews", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
};
constexpr Rule kSparseRules[] = {
    {.key = "count", .form = Form::integer, .required = true, .min = 1},
    {.key = "indices", .form = Form::object, .required = true, .members = kSparseIndicesRules},
    {.key = "values", .form = Form::object, .required = true, .members = kSparseValuesRules},
};
constexpr Rule kAccessorRules[] = {
    index_of("bufferView", "bufferViews"),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "componentType",
     .form = Form::integer,
     .required = true,
     .values = kComponentTypes,
     .repair = Repair::drop},
    {.key = "normalized", .form = Form::boolean},
    // check_storage() reports 0.
    {.key = "count", .form = Form::integer, .required = true, .min = 0},
    choice("type", kAccessorTypes, true),
    {.key = "max", .form = Form::numbers},
    {.key = "min", .form = Form::numbers},
    {.key = "sparse", .form = Form::object, .members = kSparseRules},
};

constexpr Rule kAnimationTargetRules[] = {
    index_of("node", "nodes"),
    choice("path", kPaths, true, Repair::keep),
};
constexpr Rule kChannelRules[] = {
    {.key = "sampler", .form = Form::integer, .required = true, .min = 0},
    {.key = "target",
     .form = Form::object,
     .required = true,
     .members = kAnimationTargetRules,
     .place = Place::animation_target},
};
constexpr Rule kAnimationSamplerRules[] = {
    index_of("input", "accessors", true),
    choice("interpolation", kInterpolations),
    index_of("output", "accessors", true),
};
constexpr Rule kAnimationRules[] = {
    {.key = "channels", .form = Form::objects, .required = true, .members = kChannelRules},
    {.key = "samplers", .form = Form::objects, .required = true, .members = kAnimationSamplerRules},
};

constexpr Rule kBufferRules[] = {
    {.key = "uri", .form = Form::string},
    {.key = "byteLength", .form = Form::integer, .required = true, .min = 0},
};
constexpr Rule kViewRules[] = {
    index_of("buffer", "buffers", true),
    {.key = "byteOffset", .form = Form::integer, .min = 0},
    {.key = "byteLength", .form = Form::integer, .required = true, .min = 0},
    {.key = "byteStride", .form = Form::integer, .min = 0},
    choice("target", kViewTargets),
};

constexpr Rule kOrthographicRules[] = {
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
constexpr Rule kPerspectiveRules[] = {
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
constexpr Rule kCameraRules[] = {
    {.key = "orthographic", .form = Form::object, .members = kOrthographicRules},
    {.key = "perspective", .form = Form::object, .members = kPerspectiveRules},
    choice("type", kCameraTypes, true),
};

constexpr Rule kImageRules[] = {
    {.key = "uri", .form = Form::string},
    choice("mimeType", kImageTypes, false, Repair::keep),
    index_of("bufferView", "bufferViews"),
};
constexpr Rule kSamplerRules[] = {
    choice("magFilter", kMagFilters),
    choice("minFilter", kMinFilters),
    choice("wrapS", kWrapModes),
    choice("wrapT", kWrapModes),
};
constexpr Rule kTextureRules[] = {
    index_of("sampler", "samplers"),
    index_of("source", "images"),
};

constexpr Rule kOcclusionTextureRules[] = {
    kTextureInfoRules[0],
    kTextureInfoRules[1],
    factor("strength"),
};
constexpr Rule kMetallicRoughnessRules[] = {
    color("baseColorFactor", 1, 4), texture("baseColorTexture"),         factor("metallicFactor"),
    factor("roughnessFactor"),      texture("metallicRoughnessTexture"),
};
constexpr Rule kMaterialRules[] = {
    {.key = "pbrMetallicRoughness", .form = Form::object, .members = kMetallicRoughnessRules},
    normal_texture("normalTexture"),
    texture("occlusionTexture", kOcclusionTextureRules),
    texture("emissiveTexture"),
    color("emissiveFactor"),
    choice("alphaMode", kAlphaModes),
    at_least("alphaCutoff", 0),
    {.key = "doubleSided", .form = Form::boolean},
};

constexpr Rule kPrimitiveRules[] = {
    {.key = "attributes", .form = Form::attributes, .required = true, .target = "accessors"},
    index_of("indices", "accessors"),
    index_of("material", "materials"),
    {.key = "mode", .form = Form::integer, .min = 0, .max = 6},
    {.key = "targets", .form = Form::targets, .target = "accessors"},
};
constexpr Rule kMeshRules[] = {
    {.key = "primitives",
     .form = Form::objects,
     .required = true,
     .members = kPrimitiveRules,
     .place = Place::primitive},
    {.key = "weights", .form = Form::numbers},
};

constexpr Rule kNodeRules[] = {
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
constexpr Rule kSceneRules[] = {
    {.key = "nodes", .form = Form::indices, .target = "nodes"},
};
constexpr Rule kSkinRules[] = {
    index_of("inverseBindMatrices", "accessors"),
    index_of("skeleton", "nodes"),
    {.key = "joints", .form = Form::indices, .required = true, .target = "nodes"},
};

constexpr Rule kRootRules[] = {
    {.key = "extensionsUsed", .form = Form::strings},
    {.key = "extensionsRequired", .form = Form::strings},
    {.key = "accessors", .form = Form::objects, .members = kAccessorRules},
    {.key = "animations",
     .form = Form::objects,
     .members = kAnimationRules,
     .place = Place::animation},
    {.key = "asset",
     .form = Form::object,
     .required = true,
     .members = kAssetRules,
     .place = Place::asset},
    {.key = "buffers", .form = Form::objects, .members = kBufferRules, .place = Place::buffer},
    {.key = "bufferViews",
     .form = Form::objects,
     .members = kViewRules,
     .place = Place::buffer_view},
    {.key = "cameras", .form = Form::objects, .members = kCameraRules},
    {.key = "images", .form = Form::objects, .members = kImageRules, .place = Place::image},
    {.key = "materials",
     .form = Form::objects,
     .members = kMaterialRules,
     .place = Place::material},
    {.key = "meshes", .form = Form::objects, .members = kMeshRules, .place = Place::mesh},
    {.key = "nodes", .form = Form::objects, .members = kNodeRules, .place = Place::node},
    {.key = "samplers", .form = Form::objects, .members = kSamplerRules},
    index_of("scene", "scenes"),
    {.key = "scenes", .form = Form::objects, .members = kSceneRules, .place = Place::scene},
    {.key = "skins", .form = Form::objects, .members = kSkinRules},
    {.key = "textures", .form = Form::objects, .members = kTextureRules, .place = Place::texture},
};

}  // namespace

std::span<const Rule> gltf_rules() {
  return kRootRules;
}

}  // namespace microtrace::io::gltf
