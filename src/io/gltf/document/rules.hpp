#pragma once
/// Rules for the properties of JSON objects, by which check_schema checks glTF 2.0 and its
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
  index,    ///< of an item of the root array `target`
  indices,  ///< an array of such, all different
  numbers,
  strings,              ///< an array of different strings
  object,               ///< with `members`
  objects,              ///< an array of such
  attributes,           ///< an object from attribute names to indices of accessors
  targets,              ///< an array of such: morph targets
  instance_attributes,  ///< the same with the names of EXT_mesh_gpu_instancing
  draco_attributes,     ///< an object from attribute names to integers
  anything,
};

/// The kinds of objects that extensions add to.
enum class Place {
  other,
  nowhere,   ///< of extensions that add no object
  anywhere,  ///< of extensions whose objects are not checked
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

/// What becomes of a value that is not in its rule's range or list.
enum class Repair {
  none,   ///< the asset is refused
  clamp,  ///< the nearest number of the range takes its place
  drop,   ///< its property is taken to be absent
  keep,   ///< it stays, for readers to deal with
};

struct Rule {
  std::string_view key;
  Form form;
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();  ///< of each number
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is not allowed
  std::size_t fewest = 0;  ///< items of an array
  std::size_t most = ~std::size_t{0};
  std::string_view target = {};  ///< a root array's name, or a pointer into the root's extensions
  std::span<const Rule> members = {};
  Place place = Place::other;                      ///< of the object or objects
  std::span<const double> values = {};             ///< the known numbers, if not empty
  std::span<const std::string_view> strings = {};  ///< the known strings, if not empty
  Repair repair = Repair::none;  ///< clamp and keep are for each number of an array
};

/// The rules of a texture info, and of one with a scale.
inline constexpr Rule texture_info_rules[] = {
    {.key = "index", .form = Form::index, .required = true, .target = "textures"},
    {.key = "texCoord", .form = Form::integer, .min = 0, .repair = Repair::clamp},
};
inline constexpr Rule normal_texture_rules[] = {
    texture_info_rules[0],
    texture_info_rules[1],
    {.key = "scale", .form = Form::number},
};

// Rules that many objects have.

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

constexpr Rule factor(std::string_view key) {
  return {.key = key, .form = Form::number, .min = 0, .max = 1, .repair = Repair::clamp};
}
constexpr Rule at_least(std::string_view key, double min) {
  return {.key = key, .form = Form::number, .min = min, .repair = Repair::clamp};
}
/// A number above 0; without it, or with another, its object's default.
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
/// One of the known numbers, or as if it were absent.
constexpr Rule choice(std::string_view key, std::span<const double> values) {
  return {.key = key, .form = Form::integer, .values = values, .repair = Repair::drop};
}
constexpr Rule choice(std::string_view key, std::span<const std::string_view> strings,
                      bool required = false, Repair repair = Repair::drop) {
  return {
      .key = key, .form = Form::string, .required = required, .strings = strings, .repair = repair};
}
/// A texture info with those members.
constexpr Rule texture(std::string_view key, std::span<const Rule> members = texture_info_rules) {
  return {.key = key, .form = Form::object, .members = members, .place = Place::texture_info};
}
constexpr Rule normal_texture(std::string_view key) {
  return texture(key, normal_texture_rules);
}
constexpr Rule index_of(std::string_view key, std::string_view target, bool required = false) {
  return {.key = key, .form = Form::index, .required = required, .target = target};
}

}  // namespace microtrace::io::gltf
