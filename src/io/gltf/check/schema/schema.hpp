#pragma once
/// The JSON schema of glTF 2.0 as tables of rules, one rule for each property.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/rules.hpp"

#include <span>

namespace microtrace::io::gltf {

/// The root object's rules; those of all other objects hang below.
[[nodiscard]] std::span<const Rule> gltf_rules();

/// Checks the whole asset against the rules. Throws Error (invalid_scene) at the first broken one
/// that can't be repaired. The others are repaired in the asset's JSON, with a warning, so that its
/// readers need not look again: values as their rules' `repair` says; null is taken to be absent,
/// and so are attributes of unknown names, and extensions that extensionsUsed does not declare,
/// that stand in an object that they do not belong to, or that depend on one which is absent.
/// Properties that glTF 2.0 does not define, repeated items and empty arrays stay.
void check_schema(Asset& asset);

}  // namespace microtrace::io::gltf
