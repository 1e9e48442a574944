#pragma once
/// Rays in the form that kernels take.

#include "accel/kernels/kernel.hpp"

#include <microtrace/ray.hpp>

#include <span>

namespace microtrace {

/// Whether a ray is valid and keeps KernelRay's limits.
[[nodiscard]] bool suits_kernels(const Ray& ray);

/// The caller's part of a KernelRay, for a ray that does.
[[nodiscard]] KernelRay kernel_ray(const Ray& ray);

/// The caller's part of a KernelTile for 1 to kTileRays such rays with one origin, but for their
/// best hits.
void fill_tile(std::span<const Ray> rays, KernelTile& tile);

}  // namespace microtrace
