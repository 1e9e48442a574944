#pragma once
/// Translates scenes that are far from the origin closer to it.

#include "scene/translation_to_origin.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace {

/// Path vertices are float32 points, which are far apart where coordinates are large. A scene is
/// therefore translated close to the origin if the extent of its camera and shapes is small
/// relative to their distance from the origin. The translation along each axis keeps every
/// coordinate exact, so it changes only the spacing of float32 points.

/// Bounds of all points that define the positions of shapes. Nothing if a shape, such as a quadric,
/// isn't defined by points.
[[nodiscard]] std::optional<PointBounds> bounds_of_points(const Scene& scene);

/// The translation from the scene to the origin; zero for scenes that are close to the origin or
/// large.
[[nodiscard]] DVec3 translation_to_origin(const PointBounds& points, const Camera& camera);

/// The scene with translated shapes and lights; nothing if this would round a point of a shape.
[[nodiscard]] std::optional<Scene> moved(const Scene& scene, const DVec3& by);

[[nodiscard]] Camera moved(const Camera& camera, const DVec3& by);

}  // namespace microtrace
