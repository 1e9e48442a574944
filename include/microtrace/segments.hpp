#pragma once
/// Points and lines, which have no area.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

[[nodiscard]] MICROTRACE_EXPORT bool has_segments(const Scene& scene);

/// Replaces the segments of all meshes by triangles that face the camera. There are two for each
/// segment, in order, after the mesh's own triangles: segment i has the PrimitiveIds n + 2 i and n
/// + 2 i + 1, where n is the first id after the mesh's own triangles. They are one pixel wide in a
/// picture of this size and extend half a pixel beyond the segment's ends; a segment shorter than a
/// pixel becomes a square. Segments are clipped to the view; invisible ones are replaced by two
/// empty triangles with coordinates that are not finite. Environment cameras and lens distortion
/// show lines that are wider in places, never thinner. `render` calls this function itself.
MICROTRACE_EXPORT void widen_segments(Scene& scene, const Camera& camera, ImageSize size);

}  // namespace microtrace
