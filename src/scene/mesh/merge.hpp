#pragma once
/// Merges scenes.

#include <microtrace/scene.hpp>

namespace microtrace {

/// Appends the objects, materials, textures and images of `part` to those of `whole` and adjusts
/// indices. Drops the cameras and all other members of `part`.
void merge(Scene& whole, Scene&& part);

}  // namespace microtrace
