#pragma once
/// Rays in the form that kernels take.

#include "accel/kernels/kernel.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/ray.hpp>

#include <span>

namespace microtrace {

/// The power of two 2^k for which o + t d, written as o + (2^k t) (d / 2^k), keeps KernelRay's
/// limits: 1 for a ray that suits kernels. 0 if there is none, or if a component of d / 2^k would
/// be rounded, or if the ray is not valid.
[[nodiscard]] double kernel_t_scale(const Ray& ray);

/// The caller's part of a KernelRay; t_scale is kernel_t_scale(ray), not 0, and multiplies all its
/// t.
[[nodiscard]] KernelRay kernel_ray(const Ray& ray, double t_scale);

/// The same for a ray that looks for hits after a number of which only an enclosure is known: what
/// could be on either side of it goes to the slow path.
[[nodiscard]] KernelRay kernel_ray_from(const Ray& ray, double t_scale,
                                        const exact::Enclosure& begin);

/// A tile without hits of 1 to kTileRays rays. False if they have several origins or not all of
/// them suit kernels.
[[nodiscard]] bool fill_tile(std::span<const Ray> rays, const Kernels& kernels, KernelTile& tile);

}  // namespace microtrace
