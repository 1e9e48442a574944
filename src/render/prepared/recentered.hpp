#pragma once
/// Moves scenes that are far from the origin next to it.

#include "scene/translation_to_origin.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace {

/// Paths bounce at points of float32, which lie far apart where coordinates are large. So a scene
/// of which camera and shapes together are small beside their distance from the origin is moved
/// next to it, along each axis by a number that leaves every coordinate exact: the same scene with
/// more room between its points.

/// Bounds of all points that place the shapes; nothing if a shape (a quadric) is not placed by
/// points.
[[nodiscard]] std::optional<PointBounds> bounds_of_points(const Scene& scene);

/// From there to the origin; zero for scenes that are near it or large.
[[nodiscard]] DVec3 translation_to_origin(const PointBounds& points, const Camera& camera);

/// The scene moved, shapes and lights; nothing if a point of a shape would be rounded.
[[nodiscard]] std::optional<Scene> moved(const Scene& scene, const DVec3& by);

[[nodiscard]] Camera moved(const Camera& camera, const DVec3& by);

}  // namespace microtrace
