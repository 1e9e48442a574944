#pragma once
/// Rules for the properties of JSON objects. check_schema uses them to validate glTF 2.0 and its
/// extensions.

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace microtrace::io::gltf {

enum class Form {
  boolean,
  integer,
  number,
  string,
  index,    ///< an index into the root array `target`
  indices,  ///< an array of distinct indices
  numbers,
  strings,              ///< an array of distinct strings
  object,               ///< an object described by `members`
  objects,              ///< an array of objects
  attributes,           ///< attribute names mapped to accessor indices
  targets,              ///< an array of `attributes`, one for each morph target
  instance_attributes,  ///< attribute names of EXT_mesh_gpu_instancing mapped to accessor indices
  draco_attributes,     ///< attribute names mapped to integers
  anything,
};

/// The kinds of objects that can have extensions.
enum class Place {
  other,
  nowhere,   ///< for extensions that add no objects
  anywhere,  ///< for extensions whose objects are not checked
  root,
  asset,
  animation,
  animation_target,
  buffer,
  buffer_view,
  image,
  material,
  mesh,
  node,
  primitive,
  scene,
  texture,
  texture_info,
};

/// The repair of a value that is outside its rule's range or list.
enum class Repair {
  none,   ///< no repair: the asset is rejected
  clamp,  ///< replaced by the nearest number in range
  drop,   ///< removed, which gives the default
  keep,   ///< kept, because readers handle it
};

struct Rule {
  std::string_view key;
  Form form;
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();  ///< minimum of each number
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< true if min itself is invalid
  std::size_t fewest = 0;  ///< minimum number of array items
  std::size_t most = ~std::size_t{0};
  std::string_view target = {};  ///< name of a root array, or a pointer into the root's extensions
  std::span<const Rule> members = {};
  Place place = Place::other;           ///< kind of the object, or of the array's objects
  std::span<const double> values = {};  ///< valid numbers; empty allows all
  std::span<const std::string_view> strings = {};  ///< valid strings; empty allows all
  Repair repair = Repair::none;  ///< clamp and keep apply to each number of an array
};

/// The properties of a texture info, without and with a scale.
inline constexpr Rule kTextureInfoRules[] = {
    {.key = "index", .form = Form::index, .required = true, .target = "textures"},
    {.key = "texCoord", .form = Form::integer, .min = 0, .repair = Repair::clamp},
};
inline constexpr Rule kNormalTextureRules[] = {
    kTextureInfoRules[0],
    kTextureInfoRules[1],
    {.key = "scale", .form = Form::number},
};

// Rules shared by many objects.

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

constexpr Rule factor(std::string_view key) {
  return {.key = key, .form = Form::number, .min = 0, .max = 1, .repair = Repair::clamp};
}
constexpr Rule at_least(std::string_view key, double min) {
  return {.key = key, .form = Form::number, .min = min, .repair = Repair::clamp};
}
/// Returns a number above 0. If it is absent or invalid, the default applies.
constexpr Rule positive(std::string_view key) {
  return {.key = key, .form = Form::number, .min = 0, .above_min = true, .repair = Repair::drop};
}
constexpr Rule number(std::string_view key) {
  return {.key = key, .form = Form::number};
}
constexpr Rule vector(std::string_view key, std::size_t length) {
  return {.key = key, .form = Form::numbers, .fewest = length, .most = length};
}
constexpr Rule color(std::string_view key, double max = 1, std::size_t channels = 3) {
  return {.key = key,
          .form = Form::numbers,
          .min = 0,
          .max = max,
          .fewest = channels,
          .most = channels,
          .repair = Repair::clamp};
}
/// Returns one of several numbers. An invalid number counts as absent.
constexpr Rule choice(std::string_view key, std::span<const double> values) {
  return {.key = key, .form = Form::integer, .values = values, .repair = Repair::drop};
}
constexpr Rule choice(std::string_view key, std::span<const std::string_view> strings,
                      bool required = false, Repair repair = Repair::drop) {
  return {
      .key = key, .form = Form::string, .required = required, .strings = strings, .repair = repair};
}
/// Returns a texture info with these properties.
constexpr Rule texture(std::string_view key, std::span<const Rule> members = kTextureInfoRules) {
  return {.key = key, .form = Form::object, .members = members, .place = Place::texture_info};
}
constexpr Rule normal_texture(std::string_view key) {
  return texture(key, kNormalTextureRules);
}
constexpr Rule index_of(std::string_view key, std::string_view target, bool required = false) {
  return {.key = key, .form = Form::index, .required = required, .target = target};
}

}  // namespace microtrace::io::gltf
