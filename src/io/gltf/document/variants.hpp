#pragma once
/// Selection of material variants (KHR_materials_variants).

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <string>

namespace microtrace::io::gltf {

/// Assigns to primitives the materials of a variant, given by name or by index from 0. Empty text
/// keeps the file's materials. Throws Error (usage) that lists the existing variants.
void choose_variant(const Asset& asset, const std::string& variant, Model& model);

}  // namespace microtrace::io::gltf
