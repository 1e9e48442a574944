#pragma once
/// Converts mesh primitives to triangles and segments in mesh space.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "scene/translation_to_origin.hpp"

#include <microtrace/io.hpp>
#include <microtrace/material.hpp>
#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace::io::gltf {

/// One primitive of a mesh. It has only the vertices that its triangles and segments use, in file
/// order. Generating tangents may have duplicated some of them.
struct Surface {
  Mesh mesh{};
  /// The index of each vertex in the primitive's accessors. The indices never descend.
  /// AccessorReader::read uses these indices to read other attributes.
  std::vector<std::uint32_t> vertices{};
  std::uint32_t material = 0;  ///< index among the results of make_materials and add_unlit_copies
  std::size_t number = 0;      ///< index of the primitive in its mesh
  PointBounds box{};           ///< of the vertices
};

/// Makes the surfaces of each mesh. Points and lines without normals need unlit materials: their
/// original materials are added to `unlit`, and they get the indices of the unlit copies that
/// add_unlit_copies appends later. Primitives without POSITION or data give no surface, with a
/// warning. Throws Error: invalid_scene for accessors of the wrong type or indices out of range,
/// limit.
[[nodiscard]] std::vector<std::vector<Surface>> make_surfaces(Asset& asset, const Model& model,
                                                              AccessorReader& reader,
                                                              std::span<const Material> materials,
                                                              SurfaceDetail detail,
                                                              std::vector<std::uint32_t>& unlit);

}  // namespace microtrace::io::gltf
