#pragma once
/// The JSON schema of glTF 2.0 as tables of rules, one rule per property.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/rules.hpp"

#include <span>

namespace microtrace::io::gltf {

/// The root object's rules, which refer to those of all other objects.
[[nodiscard]] std::span<const Rule> gltf_rules();

/// Checks the asset against the rules. Throws Error (invalid_scene) at the first violation that
/// can't be repaired. Repairs the others in the asset's JSON, with a warning, so that later code
/// can rely on the schema. Values are repaired as their rules' `repair` says. Null values,
/// attributes of unknown names, and extensions that are undeclared, misplaced or lack one they
/// depend on are removed. Properties unknown to glTF 2.0, repeated items and empty arrays stay.
void check_schema(Asset& asset);

}  // namespace microtrace::io::gltf
