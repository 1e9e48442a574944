#pragma once
/// What the numbers in accessors must be.

#include "io/gltf/bytes/accessors.hpp"

namespace microtrace::io::gltf {

/// Looks once at the numbers of every accessor whose data is at hand. Throws Error (invalid_scene)
/// for sparse indices out of order or range and joints that a skin does not have. Warns of floats
/// that are not finite, animation times that do not ascend, min and max that are not the least and
/// the greatest, vectors, quaternions, colors, weights and matrices that are not what their use
/// asks for, and, in primitives that are not drawn for want of positions, vertices that are not
/// there. Throws Error (limit) where accessors hold more than max_buffer_bytes in all.
void check_data(Asset& asset, const Model& model, const BufferViews& views);

}  // namespace microtrace::io::gltf
