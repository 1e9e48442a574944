#pragma once
/// Rules for relations between the objects of an asset, with one function for each kind of object.
/// The functions expect an asset that check_schema has accepted. They throw Error (invalid_scene)
/// at the first violation that can't be repaired. For each other violation, they remove the invalid
/// values from the asset's JSON and add a warning.

#include "io/gltf/check/forest.hpp"
#include "io/gltf/check/heads.hpp"
#include "io/gltf/document/asset.hpp"

#include <cstddef>

namespace microtrace::io::gltf {

/// Runs all functions below.
void check_semantics(Asset& asset);

/// Checks the declarations of buffer views and accessors. check_accessors checks their ranges.
void check_storage(Asset& asset);
void check_cameras(Asset& asset);
void check_lights(Asset& asset);
void check_images(Asset& asset, AccessorHeads& accessors);
/// Also checks the materials that variants select.
void check_materials(Asset& asset);
void check_meshes(Asset& asset, AccessorHeads& accessors);
void check_nodes(Asset& asset, const NodeForest& forest);
void check_skins(Asset& asset, AccessorHeads& accessors, const NodeForest& forest);
void check_animations(Asset& asset, AccessorHeads& accessors);

/// Returns the number of morph targets of a mesh: that of the primitive with the most. glTF 2.0
/// requires the same number of all primitives.
[[nodiscard]] std::size_t morph_target_count(const JsonValue& mesh);

/// Drops the weights of a mesh or node if their number differs from that of its morph targets.
void check_weights(Asset& asset, const Element& at, std::size_t targets);

}  // namespace microtrace::io::gltf
