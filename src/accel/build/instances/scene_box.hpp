#pragma once
#include "accel/build/float4.hpp"
#include "accel/build/tree.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::build {

/// Returns the bounding box of the transformed triangles of an instance. It is exact, so the bounds
/// of a scene don't depend on whether its meshes are instances. `tree` and `mesh` are those of the
/// instance.
[[nodiscard]] Box scene_box(const Instance& instance, const Tree& tree, const PlacedMesh& mesh);

}  // namespace microtrace::build
