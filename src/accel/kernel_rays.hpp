#pragma once
/// Rays in the form that kernels take.

#include "accel/kernels/kernel.hpp"

#include <microtrace/ray.hpp>

#include <span>

namespace microtrace {

/// Whether a valid ray keeps KernelRay's limits.
[[nodiscard]] bool suits_kernels(const Ray& ray);

/// For a ray that does.
[[nodiscard]] KernelRay kernel_ray(const Ray& ray);

/// 1 to kTileRays rays with one origin, all of which do. The best hits are left to the caller;
/// places beyond the last ray are filled.
void fill_tile(std::span<const Ray> rays, KernelTile& tile);

}  // namespace microtrace
