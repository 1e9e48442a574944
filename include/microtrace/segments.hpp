#pragma once
/// Points and lines, which have no area of their own.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

[[nodiscard]] MICROTRACE_EXPORT bool has_segments(const Scene& scene);

/// Replaces the segments of all meshes by triangles that face the camera: two for each segment, in
/// their order, after the mesh's own, so that segment i has the PrimitiveIds n + 2 i and n + 2 i +
/// 1 where n is the one after the mesh's own triangles. They are a pixel wide in a picture of that
/// size and reach half a pixel beyond the segment's ends; a segment shorter than a pixel makes a
/// square. What the camera can't see of a segment is cut off; two triangles with numbers that are
/// not finite, and so empty, stand for one out of sight. `render` does this by itself.
MICROTRACE_EXPORT void widen_segments(Scene& scene, const Camera& camera, ImageSize size);

}  // namespace microtrace
