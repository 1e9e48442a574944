#pragma once
/// Converts vertex sequences to triangles and segments.

#include "io/gltf/document/model.hpp"

#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace::io::gltf {

/// An index with this value ends one strip, fan or loop, and begins another.
inline constexpr std::uint32_t kPrimitiveRestart = 0xFFFFFFFF;

/// Adds the triangles or segments of a vertex sequence in one of the seven modes (glTF 2.0, section
/// 3.7.2.1). Each triangle has the first vertex and the winding that the specification defines. A
/// point is a segment with equal ends. Drops an incomplete last primitive. Returns true if there
/// was one.
bool add_primitives(Model::Mode mode, std::span<const std::uint32_t> vertices, Mesh& mesh);

/// Returns the indices below vertex_count that triangles and segments use, in ascending order.
/// Replaces the mesh's indices by indices into the result.
[[nodiscard]] std::vector<std::uint32_t> number_vertices(Mesh& mesh, std::size_t vertex_count);

}  // namespace microtrace::io::gltf
