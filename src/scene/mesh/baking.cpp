#include "base/system/float_environment.hpp"

#include <microtrace/shape.hpp>

#include <cstddef>
#include <utility>

namespace microtrace {
namespace {

/// Replaces each element of an array by value(index).
template <class T, class Value>
void replace(Array<T>& array, const Value& value) {
  std::vector<T> values(array.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = value(i);
  array = std::move(values);
}

}  // namespace

Mesh baked(const Mesh& mesh) {
  const FloatEnvironment environment;
  Mesh result = mesh;
  if (!mesh.placement) return result;
  replace(result.positions, [&](std::size_t i) { return mesh.position(i); });
  replace(result.normals, [&](std::size_t i) { return mesh.normal(i); });
  replace(result.tangents, [&](std::size_t i) { return mesh.tangent(i); });
  if (mesh.placement->is_mirrored())
    replace(result.triangles, [&](std::size_t i) { return mesh.corners(i); });
  result.placement.reset();
  return result;
}

}  // namespace microtrace
