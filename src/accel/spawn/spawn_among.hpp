#pragma once
/// The origin of a ray that leaves a surface, with the other surfaces of a scene.

#include "accel/build/tree.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <optional>
#include <span>

namespace microtrace {

/// Bvh::spawn_origin. `outside` names the primitives that no leaf of the tree holds; tree is null
/// if it has no leaves.
[[nodiscard]] std::optional<Vec3> spawn_among(const Primitives& primitives, const Tree* tree,
                                              std::span<const PrimitiveId> outside, const Ray& ray,
                                              PrimitiveId id, const Vec3& direction);

}  // namespace microtrace
