#pragma once
/// What the tables of the schema can't say, and the JSON alone shows.

#include "io/gltf/asset.hpp"

namespace microtrace::io::gltf {

/// Checks properties against each other, in an asset that check_schema has accepted: cameras have
/// the one projection that their type names, with angle and depths in order; min and max have as
/// many numbers as the accessor's type; strides are multiples of 4 within their views; images have
/// one source, with a URI that may be followed; animation channels name samplers that exist. Throws
/// Error (invalid_scene).
void check_consistency(Asset& asset);

}  // namespace microtrace::io::gltf
