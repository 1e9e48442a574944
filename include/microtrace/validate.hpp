#pragma once
/// Checks of scenes that were made in memory. Loaders check theirs.

#include <microtrace/export.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

/// Throws Error (invalid_scene) for the first rule that the scene breaks, with a JSON pointer to
/// the member: "/objects/3/shape/triangles". The rules:
///
/// - Indices are below the size of what they index: vertices, materials, textures, images.
/// - A mesh's normals, tangents, colors and texture coordinates are as many as its positions, or
///   none. Images have as many samples as their size says. Environment maps are not null.
/// - Numbers of shapes and cameras are finite and in the ranges that their structs document.
///
/// PreparedScene and render() check the first two by themselves: they keep a program from undefined
/// behavior. Without the third, a shape with a number that is not finite is empty.
MICROTRACE_EXPORT void validate(const Scene& scene);

}  // namespace microtrace
