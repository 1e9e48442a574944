#pragma once
#include "io/gltf/document/asset.hpp"

#include <microtrace/io.hpp>

namespace microtrace::io::gltf {

/// Returns the asset's material variants and animations.
[[nodiscard]] SceneChoices choices_of(const Asset& asset);

}  // namespace microtrace::io::gltf
