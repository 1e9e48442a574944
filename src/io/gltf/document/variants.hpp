#pragma once
/// Materials to choose among (KHR_materials_variants).

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <string>

namespace microtrace::io::gltf {

/// Gives primitives the materials of the variant of that name, else of that index from 0; empty:
/// leaves the file's. Throws Error (usage) with the names there are.
void choose_variant(const Asset& asset, const std::string& variant, Model& model);

}  // namespace microtrace::io::gltf
