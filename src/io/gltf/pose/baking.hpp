#pragma once
/// Transforms meshes to world space.

#include "io/gltf/pose/morphing.hpp"
#include "io/gltf/pose/skins.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::io::gltf {

/// Transforms a mesh in float64 and rounds the result once. No other step rounds geometry. A
/// mirroring transform reverses the winding, so front faces stay front faces (glTF 2.0, section
/// 3.7.4). Normals are transformed by the inverse transpose and normalized. A normal without
/// direction becomes zero. Morphed attributes replace the mesh's own.
[[nodiscard]] Mesh baked(const Mesh& mesh, const Morphed& morphed, const DMat4& world_from_mesh);

/// Does the same with one transform per vertex. The node's transform defines only the winding (glTF
/// 2.0, section 3.7.4), and with the vertex's transform, the handedness of tangents.
[[nodiscard]] Mesh baked(const Mesh& mesh, const Morphed& morphed, const JointBlend& blend,
                         const DMat4& world_from_node);

}  // namespace microtrace::io::gltf
