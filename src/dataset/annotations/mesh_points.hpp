#pragma once
#include <microtrace/shape.hpp>

#include <span>
#include <variant>
#include <vector>

namespace microtrace::dataset {

/// Returns the vertices of a mesh or triangle; empty for other shapes.
[[nodiscard]] inline std::vector<Vec3> mesh_points(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape))
    return {mesh->positions.begin(), mesh->positions.end()};
  if (const auto* triangle = std::get_if<Triangle>(&shape))
    return {triangle->a, triangle->b, triangle->c};
  return {};
}

}  // namespace microtrace::dataset
