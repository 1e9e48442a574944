#pragma once
/// Computes rays of perspective cameras in float64, for N lanes.

#include "scene/kernels/kernel.hpp"
#include "simd/vector3.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

template <int N>
struct LaneRays {
  Floats3<N> d;
  Float<N> t_min, t_max;
};

/// The rays from the camera toward points at depth 1, given relative to the camera's position.
template <int N>
inline LaneRays<N> rays_toward(const Doubles3<N>& toward, double near, double far) {
  const Double<N> length = square_root<N>(dot(toward, toward));
  const Float<N> t_min = to_single<N>(near * length);
  const Float<N> least = Float<N>{} + 0x1p-149F;  // t_min must be positive
  return {to_single3<N>(toward * (1 / length)), t_min < least ? least : t_min,
          to_single<N>(far * length)};
}

template <int N>
inline Doubles3<N> all_lanes(const DVec3& v) {
  const Double<N> zero{};
  return {v.x - zero, v.y - zero, v.z - zero};  // v + 0 would change -0
}

/// The point at depth 1 that appears at pixel coordinates (x, y).
template <int N>
inline Doubles3<N> toward_pixel(const Doubles3<N>& corner, const Doubles3<N>& right,
                                const Doubles3<N>& down, const Double<N>& x, const Double<N>& y) {
  return corner + right * x + down * y;
}

template <int N>
void perspective_rays(const PerspectiveRays& camera, double x, double y, Ray* rays,
                      std::size_t count) {
  const Double<N> zero{};
  Double<N> steps{};
  for (int i = 0; i < N; ++i) set_lane(steps, i, double(i));
  const Doubles3<N> corner = all_lanes<N>(camera.corner), right = all_lanes<N>(camera.right),
                    down = all_lanes<N>(camera.down);
  for (std::size_t first = 0; first < count; first += N) {
    const LaneRays<N> lanes = rays_toward<N>(
        toward_pixel<N>(corner, right, down, steps + (x + static_cast<double>(first)), y - zero),
        camera.near, camera.far);
    // Stores the lanes first, because loading numbers is faster than extracting lanes.
    float d[3][N], t_min[N], t_max[N];
    store3<N>(d, 0, lanes.d);
    store<N>(t_min, lanes.t_min);
    store<N>(t_max, lanes.t_max);
    const auto copy = [&](int i) {
      Ray& ray = rays[first + static_cast<std::size_t>(i)];
      ray.o.x = camera.origin.x;
      ray.o.y = camera.origin.y;
      ray.o.z = camera.origin.z;
      ray.t_min = t_min[i];
      ray.d.x = d[0][i];
      ray.d.y = d[1][i];
      ray.d.z = d[2][i];
      ray.t_max = t_max[i];
    };
    const std::size_t left = count - first;
    if (left >= N) {
      for (int i = 0; i < N; ++i) copy(i);
    } else {
      for (int i = 0; i < static_cast<int>(left); ++i) copy(i);
    }
  }
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
