#include "io/gltf/document/element_types.hpp"

#include <algorithm>
#include <array>

namespace microtrace::io::gltf {
namespace {

struct Shape {
  std::string_view name;
  std::size_t columns, rows;  // a vector has one column
};

/// Indexed by ElementType.
constexpr std::array<Shape, 7> kShapes = {{{"SCALAR", 1, 1},
                                           {"VEC2", 1, 2},
                                           {"VEC3", 1, 3},
                                           {"VEC4", 1, 4},
                                           {"MAT2", 2, 2},
                                           {"MAT3", 3, 3},
                                           {"MAT4", 4, 4}}};

const Shape& shape_of(ElementType type) {
  return kShapes[static_cast<std::size_t>(type)];
}

}  // namespace

ElementType element_type(std::string_view name) {
  return static_cast<ElementType>(std::ranges::find(kShapes, name, &Shape::name) - kShapes.begin());
}

std::size_t component_count(ElementType type) {
  return shape_of(type).columns * shape_of(type).rows;
}

std::size_t component_size(int component_type) {
  if (component_type == kInt8 || component_type == kUint8) return 1;
  return component_type == kInt16 || component_type == kUint16 ? 2 : 4;
}

std::size_t element_size(ElementType type, int component_type) {
  const auto [name, columns, rows] = shape_of(type);
  const std::size_t size = rows * component_size(component_type);
  return is_matrix(type) ? columns * ((size + 3) / 4 * 4) : size;
}

std::size_t element_extent(ElementType type, int component_type) {
  const auto [name, columns, rows] = shape_of(type);
  const std::size_t size = rows * component_size(component_type);
  return (columns - 1) * ((size + 3) / 4 * 4) + size;
}

}  // namespace microtrace::io::gltf
