#pragma once
#include <microtrace/shape.hpp>

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace microtrace::dataset {

/// Returns the vertices of a mesh or triangle; empty for other shapes.
[[nodiscard]] inline std::vector<Vec3> mesh_points(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    std::vector<Vec3> points;
    points.reserve(mesh->positions.size());
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) points.push_back(mesh->position(i));
    return points;
  }
  if (const auto* triangle = std::get_if<Triangle>(&shape))
    return {triangle->a, triangle->b, triangle->c};
  return {};
}

}  // namespace microtrace::dataset
