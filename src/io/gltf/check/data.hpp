#pragma once
/// What the numbers in accessors must be.

#include "io/gltf/accessors.hpp"

namespace microtrace::io::gltf {

/// Looks once at the numbers of every accessor whose data is at hand. Throws Error (invalid_scene)
/// for floats that are not finite, sparse indices out of order or range, animation times that do
/// not ascend, joints that a skin does not have, and, in primitives that are not drawn for want of
/// positions, vertices that are not there. Warns of min and max that are not the least and the
/// greatest, and of vectors, quaternions, colours, weights and matrices that are not what their use
/// asks for. Throws Error (limit) where accessors hold more than max_buffer_bytes in all.
void check_data(Asset& asset, const tinygltf::Model& model, const BufferViews& views);

}  // namespace microtrace::io::gltf
