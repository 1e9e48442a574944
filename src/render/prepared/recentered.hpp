#pragma once
/// Translates scenes that are far from the origin to near it.

#include "scene/translation_to_origin.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace {

/// Paths bounce at float32 points, which are far apart where coordinates are large. A scene whose
/// camera and shapes are small relative to their distance from the origin is therefore translated
/// to near the origin. The offset along each axis keeps every coordinate exact, so only the spacing
/// of float32 points changes.

/// Bounds of all points that define the positions of shapes. Nothing if a shape (a quadric) isn't
/// defined by points.
[[nodiscard]] std::optional<PointBounds> bounds_of_points(const Scene& scene);

/// The offset from the scene to the origin; zero for scenes that are near the origin or large.
[[nodiscard]] DVec3 translation_to_origin(const PointBounds& points, const Camera& camera);

/// The scene with shapes and lights translated; nothing if a point of a shape would be rounded.
[[nodiscard]] std::optional<Scene> moved(const Scene& scene, const DVec3& by);

[[nodiscard]] Camera moved(const Camera& camera, const DVec3& by);

}  // namespace microtrace
