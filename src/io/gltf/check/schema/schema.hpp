#pragma once
/// The JSON schema of glTF 2.0 as tables of rules, one rule for each property.

#include "io/gltf/document/asset.hpp"

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
  nowhere,
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

/// What an extension writes in one place: its object's rules.
/// Place::nowhere is for extensions that add no object at all.
struct ExtensionRule {
  std::string_view name;
  Place place;
  std::span<const Rule> members;
};

/// The root object's rules; those of all other objects hang below.
[[nodiscard]] std::span<const Rule> gltf_rules();
/// Those of a texture info, and of one with a scale; extensions have such too.
extern const Rule texture_info_rules[2];
extern const Rule normal_texture_rules[3];
[[nodiscard]] std::span<const ExtensionRule> extension_rules();

/// Checks the whole asset against the rules. Throws Error (invalid_scene) at the first broken one
/// that can't be repaired. The others are repaired in the asset's JSON, with a warning, so that its
/// readers need not look again: values as their rules' `repair` says; null is taken to be absent,
/// and so are attributes of unknown names, and extensions that extensionsUsed does not declare,
/// that stand in an object that they do not belong to, or that depend on one which is absent.
/// Properties that glTF 2.0 does not define, repeated items and empty arrays stay.
void check_schema(Asset& asset);

}  // namespace microtrace::io::gltf
