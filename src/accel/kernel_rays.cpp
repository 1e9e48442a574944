#include "accel/kernel_rays.hpp"

#include "accel/packet_order.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "exact/first_hit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace microtrace {
namespace {

// Returns false for NaN, so all numbers within the limit are finite.
bool within(const Vec3& v, float limit) {
  return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
}

// Returns the t before which hits may be culled if only hits from t on count.
float begin_at(float t) {
  return t < kLeastBegin ? 0 : std::min(t, kFarthestCoordinate);
}

// Returns true if a ray is valid and within KernelRay's limits.
bool suits_kernels(const Ray& ray) {
  return within(ray.o, kFarthestCoordinate) && within(ray.d, kLongestDirection) &&
         (std::abs(ray.d.x) >= kShortestDirection || std::abs(ray.d.y) >= kShortestDirection ||
          std::abs(ray.d.z) >= kShortestDirection) &&
         ray.t_min >= 0 && ray.t_min <= kFarthestCoordinate && ray.t_min <= ray.t_max;
}

}  // namespace

double kernel_t_scale(const Ray& ray) {
  if (suits_kernels(ray)) return 1;
  if (!exact::is_valid(ray) || !within(ray.o, kFarthestCoordinate)) return 0;
  const float size = std::max({std::abs(ray.d.x), std::abs(ray.d.y), std::abs(ray.d.z)});
  if (size >= kShortestDirection && size <= kLongestDirection) return 1;  // only t_min is too large
  const double scale = std::scalbn(1.0, std::ilogb(size));
  // Multiplying a float32 number by a power of two is exact unless it under- or overflows. Large
  // numbers can't underflow.
  const auto is_exact = [](double x) {
    return std::abs(x) > 0x1p100 || static_cast<float>(x) == x;
  };
  const bool all_exact = is_exact(ray.d.x / scale) && is_exact(ray.d.y / scale) &&
                         is_exact(ray.d.z / scale) && is_exact(ray.t_max * scale);
  return all_exact ? scale : 0;
}

KernelRay kernel_ray(const Ray& ray, double t_scale) {
  KernelRay k{};
  for (int axis = 0; axis < 3; ++axis) k.o[axis] = ray.o[axis];
  if (t_scale == 1) {
    for (int axis = 0; axis < 3; ++axis) k.d[axis] = ray.d[axis];
    k.t_min = ray.t_min;
    k.t_begin = begin_at(ray.t_min);
  } else {
    for (int axis = 0; axis < 3; ++axis) k.d[axis] = static_cast<float>(ray.d[axis] / t_scale);
    const ClosestSoFar bounds = outwards(ray.t_min * t_scale, ray.t_min * t_scale, kNoPrimitive);
    k.t_min = bounds.hi;
    k.t_begin = begin_at(bounds.lo);
  }
  k.t_max = no_hit(ray, t_scale).hi;
  k.omitted_id = kNoPrimitive;
  return k;
}

KernelRay kernel_ray_from(const Ray& ray, double t_scale, const exact::Enclosure& begin) {
  KernelRay k = kernel_ray(ray, t_scale);
  const ClosestSoFar bounds = outwards(begin.lo * t_scale, begin.hi * t_scale, kNoPrimitive);
  k.t_min = std::nextafter(bounds.hi, std::numeric_limits<float>::infinity());
  k.t_begin = std::max(k.t_begin, begin_at(bounds.lo));
  return k;
}

bool fill_packet(std::span<const Ray> rays, const Kernels& kernels, KernelPacket& packet) {
  packet.order = best_order(rays).data();
  return kernels.fill_packet(numbers_of(rays), static_cast<int>(rays.size()), packet);
}

}  // namespace microtrace
