#pragma once
/// Checks the numbers in accessors.

#include "io/gltf/bytes/accessors.hpp"

namespace microtrace::io::gltf {

/// Examines the numbers of each accessor whose data is available. Throws Error (invalid_scene) for
/// sparse indices out of order or range and for joints missing from the skin, and (limit) if the
/// accessors have more than kMaxBufferBytes together. Warns about floats that are not finite,
/// animation times that don't ascend, and a wrong min or max. Warns about vectors, quaternions,
/// colors, weights and matrices that are invalid for their use. In primitives that are not drawn
/// because they have no positions, also warns about vertex indices out of range.
void check_data(Asset& asset, const Model& model, const BufferViews& views);

}  // namespace microtrace::io::gltf
