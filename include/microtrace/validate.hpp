#pragma once
/// Validates scenes that a program makes in memory. Loaders validate the scenes that they return.

#include <microtrace/export.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

/// Throws Error (invalid_scene) if the scene violates a rule. The error names the first violation,
/// with a JSON pointer to the member, such as "/objects/3/shape/triangles". The rules:
///
/// - Indices of vertices, materials, textures and images are in range.
/// - A mesh has as many normals, tangents, colors and texture coordinates as positions, or none.
///   Images have as many samples as their size requires. Environment maps are not null.
/// - The numbers in shapes, cameras, materials, lights and the environment are within their
///   documented ranges. The origin, the background and epsilon are finite, epsilon isn't negative,
///   and each side of the size is 1 to 65536 pixels (Error (limit) above). Of normals and tangents,
///   only finiteness is checked, because rounding changes their lengths.
///
/// PreparedScene and render() always check the first two rules, because their violation would cause
/// undefined behavior. render() also checks its camera and environment by the third. Without a
/// check of the third rule, a shape with a number that is not finite is treated as empty.
MICROTRACE_EXPORT void validate(const Scene& scene);

}  // namespace microtrace
