#pragma once
/// Compares the features that an asset requires or uses with the supported ones.

#include "io/gltf/document/asset.hpp"

#include <microtrace/io.hpp>

namespace microtrace::io::gltf {

/// Checks the glTF version and the required extensions. Must run before check_schema, because the
/// version and the extensions may change the schema. Throws Error: invalid_scene, unsupported.
void check_requirements(Asset& asset);

/// Adds one warning for each kind of feature that is used but ignored. `detail` tells whether the
/// picture is flat: flat pictures ignore emission.
void warn_of_ignored_features(Asset& asset, SurfaceDetail detail);

}  // namespace microtrace::io::gltf
