#pragma once
/// The vertices of consecutive paths of a wavefront, one in each lane.

#include "render/bsdf/parameters.hpp"
#include "render/lanes/features.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/shading/points/hit_group.hpp"
#include "simd/vector_types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace microtrace {

using LaneNumbers = std::uint32_t[kShadingLanes];

/// Vertices whose light and next directions are to be sampled. Their rays, positions and normals
/// are those of `hits`.
struct alignas(64) VertexGroup {
  HitGroup hits;
  LaneNumbers id;       ///< the primitive
  LaneNumbers on_mesh;  ///< 1 for triangles of meshes that are not edge-on, whose vertices are in
                        ///< hits.lanes.corners
  LaneFloats side;      ///< 1 if the ray hits the front, -1 if it hits the back
  LaneFloats width;     ///< footprint width
  // For normal maps; only the lanes with is_mapped are set.
  LaneFloats tangents[3][3], handedness;
  NormalMapLanes normals, coat_normals;
  SurfaceLanes surface;
  // Below surfaces that transmit light:
  LaneFloats through_weight[3];  ///< weight of light that crosses the surface
  LaneNumbers media;             ///< see PathColumns
  LaneNumbers channel;
  /// The material whose constant BSDF `surface` has in a lane; null for other BSDFs.
  std::array<const TexturedMaterial*, kShadingLanes> surface_of{};

  Lanes vertices = 0;                                  ///< lanes with a vertex
  Lanes mapped = 0;                                    ///< lanes with a normal map
  Lanes plain = 0;                                     ///< lanes of vertices without features
  std::array<bsdf::Features, kShadingLanes> features;  ///< of the other lanes with a vertex
};

/// Adds a lane to group.mapped, and sets the tangents of its triangle, but not their weights.
void put_tangents(VertexGroup& group, int lane, const PlacedMesh& mesh,
                  const std::array<std::uint32_t, 3>& corners);

/// Sets the members of a lane that depend on its point: position, normals and normal maps.
void put_point(VertexGroup& group, int lane, const ShadingPoint& point);

}  // namespace microtrace
