#pragma once
/// Scenes made of scenes.

#include <microtrace/scene.hpp>

namespace microtrace {

/// Moves the objects of `part` to the end of those of `whole`, and with them materials, textures
/// and images; indices are changed to fit. Cameras and all else of `part` are dropped.
void merge(Scene& whole, Scene&& part);

}  // namespace microtrace
