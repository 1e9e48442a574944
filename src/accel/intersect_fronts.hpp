#pragma once
#include <microtrace/bvh.hpp>
#include <microtrace/ray.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

/// Sets hits[i] to the first hit of ray i, but passes through the backs of triangles of meshes in
/// `backs`, which has one bit per primitive. Null stands for none. If triangles coincide, may find
/// hits on these backs nevertheless.
void intersect_fronts(const Bvh& bvh, std::span<const Ray> rays, const std::uint32_t* backs,
                      std::span<std::optional<Hit>> hits);

}  // namespace microtrace
