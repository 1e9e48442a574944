#pragma once
/// Rules that tie parts of an asset together, one function for each kind of part. All take an asset
/// that check_schema has accepted, throw Error (invalid_scene) at the first broken rule that can't
/// be survived, and warn of the others, taking what is wrong out of the asset's JSON where its
/// readers could stumble over it.

#include "io/gltf/check/forest.hpp"
#include "io/gltf/check/heads.hpp"
#include "io/gltf/document/asset.hpp"

#include <cstddef>

namespace microtrace::io::gltf {

/// All of the below.
void check_semantics(Asset& asset);

/// Buffer views, and accessors by themselves; where they lie is check_accessors' part.
void check_storage(Asset& asset);
void check_cameras(Asset& asset);
void check_lights(Asset& asset);
void check_images(Asset& asset, AccessorHeads& accessors);
/// And which of them variants choose.
void check_materials(Asset& asset);
void check_meshes(Asset& asset, AccessorHeads& accessors);
void check_nodes(Asset& asset, const NodeForest& forest);
void check_skins(Asset& asset, AccessorHeads& accessors, const NodeForest& forest);
void check_animations(Asset& asset, AccessorHeads& accessors);

/// Drops the weights of a mesh or node where they are not one for each of its morph targets.
void check_weights(Asset& asset, const Element& at, std::size_t targets);

}  // namespace microtrace::io::gltf
