#pragma once
/// Converts rays to the form that kernels use.

#include "accel/kernels/kernel.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/ray.hpp>

#include <cstddef>
#include <span>

namespace microtrace {

/// Returns the power of two s for which the ray, written as o + (s t) (d / s), is within
/// KernelRay's limits. Returns 1 if the ray itself is within the limits. Returns 0 if there is no
/// such s, if s t_max or a component of d / s would be rounded, or if the ray is invalid.
[[nodiscard]] double kernel_t_scale(const Ray& ray);

/// Fills the members of a KernelRay that kernels don't compute themselves. t_scale is
/// kernel_t_scale(ray), which must not be 0. All values of t are multiplied by t_scale.
[[nodiscard]] KernelRay kernel_ray(const Ray& ray, double t_scale);

/// Returns a kernel ray that finds only hits after a number with the bounds `begin`. The fallback
/// must decide hits that may be on either side of the number.
[[nodiscard]] KernelRay kernel_ray_from(const Ray& ray, double t_scale,
                                        const exact::Enclosure& begin);

/// The rays as eight numbers each, which is how kernels read them, because they can't include the
/// header of Ray.
[[nodiscard]] inline const float* numbers_of(std::span<const Ray> rays) {
  static_assert(sizeof(Ray) == 8 * sizeof(float) && offsetof(Ray, t_min) == 3 * sizeof(float) &&
                offsetof(Ray, d) == 4 * sizeof(float) && offsetof(Ray, t_max) == 7 * sizeof(float));
  return &rays[0].o.x;
}

/// Fills a packet with 1 to kPacketRays rays and no hits. Returns false if the rays have different
/// origins, are invalid or exceed the kernels' limits.
[[nodiscard]] bool fill_packet(std::span<const Ray> rays, const Kernels& kernels,
                               KernelPacket& packet);

}  // namespace microtrace
