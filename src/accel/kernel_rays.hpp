#pragma once
/// Rays in the form that kernels take.

#include "accel/kernels/kernel.hpp"
#include "exact/root.hpp"

#include <microtrace/ray.hpp>

#include <span>

namespace microtrace {

/// Whether a ray is valid and keeps KernelRay's limits.
[[nodiscard]] bool suits_kernels(const Ray& ray);

/// The caller's part of a KernelRay, for a ray that does.
[[nodiscard]] KernelRay kernel_ray(const Ray& ray);

/// The same for a ray that looks for hits after a number of which only an enclosure is known: what
/// could be on either side of it goes to the slow path.
[[nodiscard]] KernelRay kernel_ray_from(const Ray& ray, const exact::Enclosure& begin);

/// Makes a tile without hits of 1 to kTileRays rays with one origin. False if not all of them suit
/// kernels.
[[nodiscard]] bool fill_tile(std::span<const Ray> rays, const Kernels& kernels, KernelTile& tile);

}  // namespace microtrace
