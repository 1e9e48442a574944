#pragma once
/// Validation of scenes that were made in memory. Loaders validate theirs.

#include <microtrace/export.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

/// Throws Error (invalid_scene) for the first rule that the scene violates, with a JSON pointer to
/// the member, such as "/objects/3/shape/triangles". The rules:
///
/// - Indices of vertices, materials, textures and images are in range.
/// - A mesh has as many normals, tangents, colors and texture coordinates as positions, or none.
///   Images have as many samples as their size requires. Environment maps are not null.
/// - Numbers of shapes, cameras, materials, lights and the environment are in the documented
/// ranges.
///
/// PreparedScene and render() always check the first two, which prevent undefined behavior. If the
/// third is not checked, a shape with a number that is not finite is empty.
MICROTRACE_EXPORT void validate(const Scene& scene);

}  // namespace microtrace
