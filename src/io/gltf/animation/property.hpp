#pragma once
/// Properties of materials, cameras, lights and nodes that KHR_animation_pointer can animate.

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
  double min = 0, max = 0;  ///< range of each number
};

/// The property that a JSON pointer names (glTF 2.0 Asset Object Model): a number or vector of a
/// material, its extensions or texture transforms, of a camera, of a light (KHR_lights_punctual),
/// or a node's visibility (KHR_node_visibility). Nothing if the object is absent or the property
/// can't be animated.
[[nodiscard]] std::optional<AnimatedProperty> find_property(const Asset& asset,
                                                            std::string_view pointer);

/// A copy of the members of the root object, nodes excepted, that find_property can lead to.
[[nodiscard]] JsonValue animated_part(const JsonValue& root);

/// Writes a value, clamped to the property's range, into a copy made by animated_part.
void set_property(JsonValue& part, const AnimatedProperty& property,
                  const std::vector<double>& value);

/// Repairs contradictions between animated values: near and far planes, cone angles, and values
/// inside a gap of their range.
void repair_properties(JsonValue& part);

}  // namespace microtrace::io::gltf
