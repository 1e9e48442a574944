#pragma once
/// The JSON schema of glTF 2.0 as tables of rules, one rule for each property.

#include "io/gltf/asset.hpp"

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
  strings,     ///< an array of different strings
  object,      ///< with `members`
  objects,     ///< an array of such
  attributes,  ///< an object from attribute names to indices of accessors
  targets,     ///< an array of such: morph targets
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
  std::string_view target = {};
  std::span<const Rule> members = {};
  std::span<const double> values = {};             ///< the allowed numbers, if not empty
  std::span<const std::string_view> strings = {};  ///< the allowed strings, if not empty
};

/// The root object's rules; those of all other objects hang below.
[[nodiscard]] std::span<const Rule> gltf_rules();

/// Checks the whole asset against the rules. Throws Error (invalid_scene) at the first broken one;
/// warns of properties that glTF 2.0 does not define and of empty arrays, which it forbids.
void check_schema(Asset& asset);

}  // namespace microtrace::io::gltf
