#pragma once
/// Tangents for meshes that come without.

#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// Gives a mesh the tangents that MikkTSpace defines for one of its sets of texture coordinates,
/// which it has (M. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and the rules of
/// its implementation, by which normal maps are baked). w is such that the bitangent goes up in the
/// image, against v (glTF 2.0, section 3.7.2.1). A mesh without normals is taken as flat. Vertices
/// are split where triangles that meet there have different tangents. Where texture coordinates
/// have no direction, neighbours' tangents hold, and without such any direction across the normal.
/// Returns, for each new vertex, which one it was, not descending.
std::vector<std::uint32_t> make_tangents(Mesh& mesh, std::size_t uv_set);

}  // namespace microtrace
