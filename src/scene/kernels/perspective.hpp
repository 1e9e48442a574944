#pragma once
/// Computes rays of perspective cameras in float64, for N lanes.

#include "scene/kernels/kernel.hpp"
#include "simd/transpose.hpp"
#include "simd/vector3.hpp"

#include <cstddef>

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

/// The point at depth 1 that appears at pixel coordinates (x, y).
template <int N>
inline Doubles3<N> toward_pixel(const Doubles3<N>& corner, const Doubles3<N>& right,
                                const Doubles3<N>& down, const Double<N>& x, const Double<N>& y) {
  return corner + right * x + down * y;
}

/// Stores the first `count` of N rays. Stores four rays at a time as the rows of a transposed
/// matrix, because extracting lanes is slow.
template <int N>
inline void store_rays(const Vec3& o, const LaneRays<N>& lanes, Ray* rays, std::size_t count) {
  float d[3][N], t_min[N], t_max[N];
  store3<N>(d, 0, lanes.d);
  store<N>(t_min, lanes.t_min);
  store<N>(t_max, lanes.t_max);
  const auto copy = [&](std::size_t i) {
    Ray& ray = rays[i];
    ray.o.x = o.x;
    ray.o.y = o.y;
    ray.o.z = o.z;
    ray.t_min = t_min[i];
    ray.d.x = d[0][i];
    ray.d.y = d[1][i];
    ray.d.z = d[2][i];
    ray.t_max = t_max[i];
  };
  std::size_t i = 0;
  if constexpr (N >= 4) {
    for (; i < N && i + 4 <= count; i += 4) {
      Float<4> first[4] = {all<4>(o.x), all<4>(o.y), all<4>(o.z), load<4>(t_min + i)};
      Float<4> second[4] = {load<4>(d[0] + i), load<4>(d[1] + i), load<4>(d[2] + i),
                            load<4>(t_max + i)};
      transpose<4>(first);
      transpose<4>(second);
      static_assert(sizeof(Ray) == 8 * sizeof(float) && offsetof(Ray, d) == 4 * sizeof(float));
      for (std::size_t k = 0; k < 4; ++k) {
        __builtin_memcpy(&rays[i + k].o, &first[k], sizeof first[k]);
        __builtin_memcpy(&rays[i + k].d, &second[k], sizeof second[k]);
      }
    }
  }
  for (; i < N && i < count; ++i) copy(i);
}

template <int N>
void perspective_rays(const PerspectiveRays& camera, const double* x, const double* y, Ray* rays,
                      std::size_t count) {
  const Doubles3<N> corner = all_lanes<N>(camera.corner), right = all_lanes<N>(camera.right),
                    down = all_lanes<N>(camera.down);
  const Float<N> least = all<N>(camera.least_t_min);
  for (std::size_t first = 0; first < count; first += N) {
    const std::size_t left = count - first, size = left < N ? left : N;
    Double<N> pixel_x{}, pixel_y{};
    __builtin_memcpy(&pixel_x, x + first, size * sizeof(double));
    __builtin_memcpy(&pixel_y, y + first, size * sizeof(double));
    LaneRays<N> lanes = rays_toward<N>(toward_pixel<N>(corner, right, down, pixel_x, pixel_y),
                                       camera.near, camera.far);
    lanes.t_min = lanes.t_min < least ? least : lanes.t_min;
    store_rays<N>(camera.origin, lanes, rays + first, size);
  }
}

/// The derivative of the directions d of a perspective camera per pixel, where `step` is the change
/// of a vector of depth 1 per pixel. Differentiates d = toward / |toward|.
template <int N>
inline Doubles3<N> direction_step(const Doubles3<N>& forward, const Doubles3<N>& step,
                                  const Doubles3<N>& d) {
  return dot(forward, d) * (step - d * dot(d, step));
}

template <int N>
void row_spreads(const DVec3& forward, const DVec3& down, const float* const (&d)[3],
                 double* spreads, std::size_t count) {
  for (std::size_t i = 0; i < count; i += N) {
    const Doubles3<N> direction{widened<N>(d[0] + i), widened<N>(d[1] + i), widened<N>(d[2] + i)};
    const Doubles3<N> step =
        direction_step<N>(all_lanes<N>(forward), all_lanes<N>(down), direction);
    const Double<N> spread = square_root<N>(dot(step, step) / dot(direction, direction));
    __builtin_memcpy(spreads + i, &spread, sizeof spread);
  }
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
