#pragma once
/// Selects material variants (KHR_materials_variants).

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Returns the names of the asset's variants. Empty where absent.
[[nodiscard]] std::vector<std::string> variant_names(const Asset& asset);

/// Assigns the materials of a variant to primitives. The variant is given by name or by index from
/// 0. An empty text keeps the materials that the file assigns. Throws an Error (usage) that lists
/// the existing variants.
void choose_variant(const Asset& asset, const std::string& variant, Model& model);

}  // namespace microtrace::io::gltf
