#pragma once
/// A camera that sees a whole model.

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// A perspective camera of 45 degrees for a 4:3 picture, looking along (-4, -4, -7) with +y up:
/// onto the front, from the right and above. All vertices of the scene's meshes lie in the inner 90
/// % of the picture, and touch its edges on two opposite sides; except that the camera keeps a
/// distance of 1/64 of the bounding box's diagonal from the nearest vertex. Vertices that are not
/// finite are left out; without extent, the distance is 1. The same bits everywhere: only + - * /
/// and sqrt.
[[nodiscard]] PerspectiveCamera frame(const std::vector<Object>& objects);

}  // namespace microtrace::io::gltf
