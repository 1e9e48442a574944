#pragma once
/// Merges scenes.

#include <microtrace/scene.hpp>

namespace microtrace {

/// Moves the objects of `part`, with their materials, textures and images, to the end of those of
/// `whole`, and adjusts indices. Cameras and everything else of `part` are dropped.
void merge(Scene& whole, Scene&& part);

}  // namespace microtrace
