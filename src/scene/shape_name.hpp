#pragma once
#include <microtrace/shape.hpp>

#include <array>
#include <string_view>
#include <variant>

namespace microtrace {

/// Returns the shape's name in JSON scenes.
[[nodiscard]] inline std::string_view type_name(const Shape& shape) {
  constexpr std::array<std::string_view, 6> kTypes = {"sphere",   "plane",   "disc",
                                                      "triangle", "quadric", "mesh"};
  static_assert(std::variant_size_v<Shape> == kTypes.size());
  return kTypes[shape.index()];
}

}  // namespace microtrace
