#pragma once
/// Transformation of meshes to world space.

#include "io/gltf/pose/morphing.hpp"
#include "io/gltf/pose/skins.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::io::gltf {

/// Transforms a mesh in float64 and rounds once, the only rounding of geometry. A mirroring
/// transform reverses the winding, so that front faces stay front faces (glTF 2.0, section 3.7.4).
/// Normals are transformed by the inverse transpose and normalized; a normal without direction
/// becomes zero. Morphed attributes replace the mesh's own.
[[nodiscard]] Mesh baked(const Mesh& mesh, const Morphed& morphed, const DMat4& world_from_mesh);

/// The same with one transform per vertex. A triangle's winding is reversed if the transform of its
/// first vertex mirrors.
[[nodiscard]] Mesh baked(const Mesh& mesh, const Morphed& morphed, const JointBlend& blend);

}  // namespace microtrace::io::gltf
