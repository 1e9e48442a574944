#pragma once
#include "accel/build/tree.hpp"

#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>

#include <span>

namespace microtrace {

/// Implements Bvh::is_clear. `unbounded` lists the primitives that are not in the tree. `tree` must
/// be null if the tree has no leaves.
[[nodiscard]] bool is_clear_among(const Primitives& primitives, const Tree* tree,
                                  std::span<const PrimitiveId> unbounded, const Vec3& p);

}  // namespace microtrace
