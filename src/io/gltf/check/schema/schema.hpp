#pragma once
/// The JSON schema of glTF 2.0 as tables of rules, one rule per property.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/rules.hpp"

#include <span>

namespace microtrace::io::gltf {

/// Returns the rules of the root object, which refer to the rules of all other objects.
[[nodiscard]] std::span<const Rule> gltf_rules();

/// Checks the asset against the rules. Throws Error (invalid_scene) at the first violation that
/// can't be repaired. Repairs all other violations in the asset's JSON, with a warning for each, so
/// later code can rely on the schema. Invalid values are repaired as Rule::repair specifies. Null
/// values and attributes with unknown names are removed. Extensions are removed if they are
/// undeclared, misplaced, or lack an extension on which they depend. Properties unknown to glTF
/// 2.0, repeated items and empty arrays stay.
void check_schema(Asset& asset);

}  // namespace microtrace::io::gltf
