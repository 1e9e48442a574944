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
  std::size_t width = 1;    ///< number of components of a value
  double min = 0, max = 0;  ///< range of each component
};

/// Finds the property that a JSON pointer names (glTF 2.0 Asset Object Model). A property is a
/// number or vector of a material, a camera or a light (KHR_lights_punctual), or the visibility of
/// a node (KHR_node_visibility). Extensions and texture transforms belong to the material. Returns
/// nothing if the object is absent or the property can't be animated.
[[nodiscard]] std::optional<AnimatedProperty> find_property(const Asset& asset,
                                                            std::string_view pointer);

/// Copies the root object's members in which find_property finds properties, except for the nodes.
[[nodiscard]] JsonValue animated_part(const JsonValue& root);

/// Writes a value, clamped to the property's range, into a copy made by animated_part.
void set_property(JsonValue& part, const AnimatedProperty& property,
                  const std::vector<double>& value);

/// Repairs animated values that contradict each other or the schema: near and far planes, cone
/// angles, and values in a gap of their valid range.
void repair_properties(JsonValue& part);

}  // namespace microtrace::io::gltf
