#pragma once
/// Computes the origin of a ray that leaves a surface, taking the scene's other surfaces into
/// account.

#include "accel/build/tree.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <optional>
#include <span>

namespace microtrace {

/// Implements Bvh::spawn_origin. `unbounded` lists the primitives that are not in the tree. `tree`
/// must be null if the tree has no leaves.
[[nodiscard]] std::optional<Vec3> spawn_among(const Primitives& primitives, const Tree* tree,
                                              std::span<const PrimitiveId> unbounded,
                                              const Ray& ray, PrimitiveId id,
                                              const Vec3& direction);

}  // namespace microtrace
