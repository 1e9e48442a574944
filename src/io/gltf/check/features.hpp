#pragma once
/// What an asset asks for and this program can or can't do.

#include "io/gltf/document/asset.hpp"

#include <microtrace/io.hpp>

namespace microtrace::io::gltf {

/// Checks the glTF version and the required extensions, and so must come before check_schema, as
/// either may change the schema. Throws Error: invalid_scene, unsupported.
void check_requirements(Asset& asset);

/// One warning for each kind of feature that is present and not honoured; emission is not where the
/// detail is for flat pictures.
void warn_of_ignored_features(Asset& asset, SurfaceDetail detail);

}  // namespace microtrace::io::gltf
