#pragma once
/// From a mesh's own space to the world.

#include "io/gltf/pose/morphing.hpp"
#include "io/gltf/pose/skins.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::io::gltf {

/// The one rounding of geometry: everything is computed in float64. A mirroring transform turns
/// every triangle over, so that fronts stay fronts (glTF 2.0, section 3.7.4). Normals go by the
/// inverse transpose, to unit length; they are zero where they have no direction. What is morphed
/// replaces the mesh's own.
[[nodiscard]] Mesh baked(const Mesh& mesh, const Morphed& morphed, const DMat4& world_from_mesh);

/// The same with a transform for each vertex. A triangle is turned over where that of its first
/// corner mirrors.
[[nodiscard]] Mesh baked(const Mesh& mesh, const Morphed& morphed, const JointBlend& blend);

}  // namespace microtrace::io::gltf
