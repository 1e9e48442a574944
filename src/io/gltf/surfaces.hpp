#pragma once
/// The triangles of mesh primitives, in the mesh's own space.

#include "io/gltf/accessors.hpp"
#include "io/gltf/asset.hpp"
#include "io/gltf/model.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <vector>

namespace microtrace::io::gltf {

/// No asset has more elements in accessors without a buffer view, more indices in all its
/// primitives, and no scene more triangles or vertices in all instances of its meshes.
inline constexpr std::size_t max_elements = std::size_t{1} << 27;

/// One primitive of a mesh: only the vertices that its triangles use, in the order of the file.
struct Surface {
  Mesh mesh;
  int material = -1;
  std::size_t number = 0;  ///< among the mesh's primitives
};

/// The surfaces of each mesh, by its index. Primitives without POSITION or without data,
/// points and lines make none, with a warning. Throws Error: invalid_scene where accessors are not
/// what the primitive needs or indices are out of range, unsupported for quantised positions,
/// limit.
[[nodiscard]] std::vector<std::vector<Surface>> make_surfaces(Asset& asset,
                                                              const tinygltf::Model& model,
                                                              const std::vector<Buffer>& buffers);

}  // namespace microtrace::io::gltf
