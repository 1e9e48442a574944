#pragma once
/// The features that an asset requires or uses, compared with the supported ones.

#include "io/gltf/document/asset.hpp"

#include <microtrace/io.hpp>

namespace microtrace::io::gltf {

/// Checks the glTF version and the required extensions. Comes before check_schema, because both may
/// change the schema. Throws Error: invalid_scene, unsupported.
void check_requirements(Asset& asset);

/// Adds one warning for each kind of feature that is used but ignored. Flat pictures ignore
/// emission.
void warn_of_ignored_features(Asset& asset, SurfaceDetail detail);

}  // namespace microtrace::io::gltf
