#pragma once
/// Rendering of points and lines, which have no area.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

[[nodiscard]] MICROTRACE_EXPORT bool has_segments(const Scene& scene);

/// Replaces each segment of all meshes by two triangles that face the camera and follow the mesh's
/// own triangles in order. Segment i gets the PrimitiveIds n + 2 i and n + 2 i + 1, where n is the
/// first id after the mesh's own triangles.
///
/// The two triangles are slightly more than one pixel wide in a picture of this size and extend
/// half a pixel beyond the segment's ends. A segment shorter than a pixel becomes a square.
/// Segments are clipped to the view; invisible ones are replaced by two empty triangles with
/// coordinates that are not finite. With environment cameras and lens distortion, lines are wider
/// than a pixel in places, but never thinner. render() calls this function itself.
MICROTRACE_EXPORT void widen_segments(Scene& scene, const Camera& camera, ImageSize size);

}  // namespace microtrace
