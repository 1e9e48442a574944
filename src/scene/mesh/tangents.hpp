#pragma once
/// Generates tangents for meshes without them.

#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// Gives a mesh the tangents that MikkTSpace defines for one of its sets of texture coordinates,
/// which must exist (M. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and the rules
/// of its implementation, the standard for baked normal maps). The sign of w lets the bitangent
/// point up in the image, against v (glTF 2.0, section 3.7.2.1). A mesh without normals is treated
/// as flat. Vertices are split if triangles that meet there have different tangents. Triangles
/// whose texture coordinates have no direction use their neighbors' tangents, or without neighbors
/// any direction perpendicular to the normal. Returns, for each new vertex, the index of the
/// original one, in nondecreasing order.
std::vector<std::uint32_t> make_tangents(Mesh& mesh, std::size_t uv_set);

}  // namespace microtrace
