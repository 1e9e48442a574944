#pragma once
/// The triangles and lines of mesh primitives, in the mesh's own space.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <microtrace/io.hpp>
#include <microtrace/material.hpp>
#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace::io::gltf {

/// One primitive of a mesh: only the vertices that it uses, in the order of the file; some more
/// than once where tangents were made.
struct Surface {
  Mesh mesh{};
  /// Which of the primitive's vertices each of the mesh is, not descending: AccessorReader::read
  /// takes them to read other attributes.
  std::vector<std::uint32_t> vertices{};
  std::uint32_t material = 0;  ///< of make_materials and the copies after them
  std::size_t number = 0;      ///< among the mesh's primitives
};

/// The surfaces of each mesh, by its index. Points and lines without normals take the materials
/// that add_unlit_copies appends for those named in `unlit`, which are added there. Primitives
/// without POSITION or without data make none, with a warning. Throws Error: invalid_scene where
/// accessors are not what the primitive needs or indices are out of range, limit.
[[nodiscard]] std::vector<std::vector<Surface>> make_surfaces(Asset& asset, const Model& model,
                                                              AccessorReader& reader,
                                                              std::span<const Material> materials,
                                                              SurfaceDetail detail,
                                                              std::vector<std::uint32_t>& unlit);

}  // namespace microtrace::io::gltf
