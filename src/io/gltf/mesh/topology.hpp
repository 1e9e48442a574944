#pragma once
/// Conversion of vertex sequences to triangles and segments.

#include "io/gltf/document/model.hpp"

#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace::io::gltf {

/// Index that ends one strip, fan or loop and begins another.
inline constexpr std::uint32_t kPrimitiveRestart = 0xFFFFFFFF;

/// Adds the primitives of a vertex sequence in one of the seven modes (glTF 2.0, section 3.7.2.1):
/// triangles with the first vertex and winding that the specification gives, or segments. A point
/// is a segment with equal ends. Drops an incomplete last primitive and returns whether there was
/// one.
bool add_primitives(Model::Mode mode, std::span<const std::uint32_t> vertices, Mesh& mesh);

/// The indices below vertex_count that triangles and segments use, ascending. Renumbers the mesh's
/// indices as indices into the result.
[[nodiscard]] std::vector<std::uint32_t> number_vertices(Mesh& mesh, std::size_t vertex_count);

}  // namespace microtrace::io::gltf
