#pragma once
/// Scenes far from the origin, moved there.

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace {

struct PlacedScene {
  Scene scene;
  Camera camera;
};

/// Paths bounce at points of float32, which lie far apart where coordinates are large. So a scene
/// of which camera and shapes together are small beside their distance from the origin is moved
/// next to it, by a number of each axis that leaves every coordinate exact: it is the same scene
/// with more room between its points. Nothing where that is not so, or where a shape can't be moved
/// exactly.
[[nodiscard]] std::optional<PlacedScene> recentred(const Scene& scene, const Camera& camera);

}  // namespace microtrace
