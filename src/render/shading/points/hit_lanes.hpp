#pragma once
/// Converts hits of mesh triangles to lanes, and lanes to the points that kernels have computed.
/// The kernels' own translation units must not include this header.

#include "render/lanes/lane_access.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/shading/points/surface_point.hpp"

namespace microtrace {

[[nodiscard]] inline bool has_uv(const Mesh& mesh, std::uint32_t set = 0) {
  return set < mesh.uv_sets.size() && !mesh.uv_sets[set].empty();
}

/// Prefetches what put_positions() and put_attributes() read.
inline void prefetch_corners(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  for (const std::uint32_t corner : corners) {
    __builtin_prefetch(&mesh.positions[corner]);
    if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[corner]);
    if (has_uv(mesh)) __builtin_prefetch(&mesh.uv_sets[0][corner]);
  }
}

template <int width>
void put_attributes(HitArrays<width>& lanes, int lane, const PlacedMesh& mesh,
                    const std::array<std::uint32_t, 3>& corners) {
  const bool has_normals = !mesh.arrays->normals.empty();
  const Vec2* uvs = has_uv(*mesh.arrays) ? mesh.arrays->uv_sets[0].data() : nullptr;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t corner = corners[i];
    put(lanes.normals[i], lane, has_normals ? mesh.normal(corner) : Vec3(0));
    const Vec2 uv = uvs == nullptr ? Vec2(0) : uvs[corner];
    lanes.uv[i][0][lane] = uv.x;
    lanes.uv[i][1][lane] = uv.y;
  }
}

template <int width>
void put_positions(HitArrays<width>& lanes, int lane, const PlacedMesh& mesh,
                   const std::array<std::uint32_t, 3>& corners) {
  for (std::size_t i = 0; i < 3; ++i) put(lanes.corners[i], lane, mesh.position(corners[i]));
}

/// Sets the attributes that interpolate() computes. at.mesh must be set.
template <int width>
void get_attributes(const HitArrays<width>& lanes, int lane, SurfacePoint& at) {
  at.n = got(lanes.n, lane);
  at.ns = got(lanes.ns, lane);
  const bool is_textured = has_uv(*at.mesh.arrays);
  at.first_uv = is_textured ? Vec2(lanes.first_uv[0][lane], lanes.first_uv[1][lane]) : Vec2(0);
  at.first_uv_scale = is_textured ? lanes.first_uv_scale[lane] : 0;
}

/// Sets all members that find_points() has computed. lanes.is_sure must be 1 for this lane, and
/// at.mesh and at.corners must be set.
template <int width>
void get_sure_point(const HitArrays<width>& lanes, int lane, SurfacePoint& at) {
  at.p = got(lanes.p, lane);
  at.front = lanes.from_behind[lane] == 0;
  at.distance = lanes.distance[lane];
  at.barycentrics = got(lanes.weights, lane);
  get_attributes(lanes, lane, at);
}

}  // namespace microtrace
