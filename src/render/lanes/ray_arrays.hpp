#pragma once
/// Arrays of the rays of a wavefront. The kernels' own translation units must not include this
/// header.

#include "accel/ray_stream.hpp"

#include <microtrace/integrator.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>

namespace microtrace {

/// One element for each path of a wavefront. The arrays of a path lie side by side; unused elements
/// at their ends keep equal indices from mapping to the same cache sets.
inline constexpr std::size_t kPathColumn = kRandomBatch + 16;
using PathFloats = float[kPathColumn];
using PathNumbers = std::uint32_t[kPathColumn];

[[nodiscard]] inline Vec3 vector_of(const PathFloats (&columns)[3], std::size_t i) {
  return {columns[0][i], columns[1][i], columns[2][i]};
}
inline void put_vector(PathFloats (&columns)[3], std::size_t i, const Vec3& v) {
  columns[0][i] = v.x;
  columns[1][i] = v.y;
  columns[2][i] = v.z;
}

/// Rays in one array per component.
struct alignas(64) RayArrays {
  PathFloats o[3], d[3], t_max;
  PathNumbers left;
};

/// The first `count` rays of RayArrays, PathColumns (except for camera rays, whose t_min is not 0)
/// or ShadowColumns.
template <class Arrays>
[[nodiscard]] RayColumns columns_of(const Arrays& rays, std::size_t count) {
  return {.o = {rays.o[0], rays.o[1], rays.o[2]},
          .d = {rays.d[0], rays.d[1], rays.d[2]},
          .t_max = rays.t_max,
          .left = rays.left,
          .count = count};
}

}  // namespace microtrace
