#pragma once
/// Generates tangents for meshes without them.

#include <microtrace/material.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace {

/// Returns the set of texture coordinates from which a mesh's missing tangents are generated (glTF
/// 2.0, section 3.7.2.1). Returns nothing if the material needs no tangents, or if the mesh has
/// tangents, no triangles, or no such set.
[[nodiscard]] std::optional<std::uint32_t> missing_tangents(const Material& material,
                                                            const Mesh& mesh);

/// Gives a mesh the tangents that MikkTSpace defines for one of its sets of texture coordinates.
/// The set must exist. MikkTSpace is the standard for baked normal maps (M. Mikkelsen, Simulation
/// of Wrinkled Surfaces Revisited, 2008, and its implementation). The sign of w makes the bitangent
/// point up in the image, against v (glTF 2.0, section 3.7.2.1). A mesh without normals is treated
/// as flat. Vertices are split where triangles with different tangents meet. Triangles with
/// degenerate texture coordinates use their neighbors' tangents, or any direction perpendicular to
/// the normal if they have no neighbors. Returns each new vertex's original index, in nondecreasing
/// order. Charges the memory to memory_account(). Throws Error (limit) if the memory exceeds its
/// limit, or for more than 2^32 corners.
std::vector<std::uint32_t> make_tangents(Mesh& mesh, std::size_t uv_set);

}  // namespace microtrace
