#pragma once
/// Conversion of rays to the form that kernels use.

#include "accel/kernels/kernel.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/ray.hpp>

#include <span>

namespace microtrace {

/// The power of two 2^k for which the ray, written as o + (2^k t) (d / 2^k), is within KernelRay's
/// limits; 1 if the ray is already within them. Returns 0 if there is none, if a component of d /
/// 2^k would be rounded, or if the ray is invalid.
[[nodiscard]] double kernel_t_scale(const Ray& ray);

/// Fills the caller's part of a KernelRay. t_scale is kernel_t_scale(ray), not 0; all values of t
/// are multiplied by it.
[[nodiscard]] KernelRay kernel_ray(const Ray& ray, double t_scale);

/// The same for a ray that looks for hits after a number with known bounds. The fallback decides
/// hits that may be on either side of the number.
[[nodiscard]] KernelRay kernel_ray_from(const Ray& ray, double t_scale,
                                        const exact::Enclosure& begin);

/// Fills a packet of 1 to kPacketRays rays, without hits. Returns false if the rays have different
/// origins or exceed the kernels' limits.
[[nodiscard]] bool fill_packet(std::span<const Ray> rays, const Kernels& kernels,
                               KernelPacket& packet);

}  // namespace microtrace
