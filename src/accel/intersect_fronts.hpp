#pragma once
#include "base/bit_set.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/ray.hpp>

#include <optional>
#include <span>

namespace microtrace {

/// Sets hits[i] to the first hit of ray i, but passes through the backs of triangles of meshes in
/// `backs`. If triangles coincide, may find hits on these backs nevertheless.
void intersect_fronts(const Bvh& bvh, std::span<const Ray> rays, BitPages backs,
                      std::span<std::optional<Hit>> hits);

}  // namespace microtrace
