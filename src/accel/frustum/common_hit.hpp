#pragma once
/// Finds the primitive that all rays of a frustum hit first.

#include "accel/build/tree.hpp"

#include <microtrace/frustum.hpp>
#include <microtrace/primitives.hpp>

namespace microtrace {

/// See Bvh::common_hit. The result is usually unknown where several primitives are visible, and
/// where the tree is deep.
[[nodiscard]] CommonHit common_hit(const Primitives& primitives, const Tree& tree,
                                   const Frustum& frustum);

}  // namespace microtrace
