#pragma once
/// What extensions add to materials.

#include "io/json/document.hpp"

#include <microtrace/material.hpp>

namespace microtrace::io::gltf {

/// Reads the extensions KHR_materials_* of a material that has its other properties already.
/// KHR_materials_pbrSpecularGlossiness counts where there is no pbrMetallicRoughness.
void read_material_extensions(const JsonValue& json, Material& material);

/// Removes what a factor of 0 makes invisible, with its textures.
void leave_out_unused_layers(Material& material);

}  // namespace microtrace::io::gltf
