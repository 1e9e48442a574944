#pragma once
/// From lists of vertices to triangles and lines.

#include "io/gltf/document/model.hpp"

#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace::io::gltf {

/// In a list of vertices, the end of one strip, fan or loop and the start of another.
inline constexpr std::uint32_t restart = 0xFFFFFFFF;

/// Adds what a list of vertices makes in one of the seven modes (glTF 2.0, section 3.7.2.1):
/// triangles, first corner and winding as written there, or segments, with both ends one for a
/// point. An incomplete last one is left out; returns whether there is such.
bool add_primitives(Model::Mode mode, std::span<const std::uint32_t> vertices, Mesh& mesh);

/// The vertices below vertex_count that triangles and segments use, ascending; makes their indices
/// those into the result.
[[nodiscard]] std::vector<std::uint32_t> number_vertices(Mesh& mesh, std::size_t vertex_count);

}  // namespace microtrace::io::gltf
