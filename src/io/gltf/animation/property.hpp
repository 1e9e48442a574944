#pragma once
/// Properties of materials, cameras, lights and nodes that KHR_animation_pointer may change.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

struct AnimatedProperty {
  std::vector<std::string> path{};  ///< reference tokens of the JSON pointer
  bool is_boolean = false;
  bool is_array = false;
  std::size_t width = 1;    ///< numbers in a value
  double min = 0, max = 0;  ///< of each number
};

/// What a JSON pointer leads to (glTF 2.0 Asset Object Model): a number or vector of a material,
/// its extensions and texture transforms, of a camera or a light of KHR_lights_punctual, or the
/// visibility of a node (KHR_node_visibility). Nothing where the asset has no such property, whose
/// object must be there, or where it can't be animated.
[[nodiscard]] std::optional<AnimatedProperty> find_property(const Asset& asset,
                                                            std::string_view pointer);

/// The root object with what find_property leads to, but nodes.
[[nodiscard]] JsonValue animated_part(const JsonValue& root);

/// Writes a value into a copy made by animated_part, in the range of the property.
void set_property(JsonValue& part, const AnimatedProperty& property,
                  const std::vector<double>& value);

/// Puts right what values that were written break together: planes of cameras, cones of lights, and
/// numbers whose range has a gap.
void repair_properties(JsonValue& part);

}  // namespace microtrace::io::gltf
