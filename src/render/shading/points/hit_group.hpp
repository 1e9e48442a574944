#pragma once
/// The hits of consecutive rays, one in each lane.

#include "render/lanes/shading_kernels.hpp"
#include "render/shading/shading.hpp"
#include "simd/vector_types.hpp"

#include <array>
#include <cstdint>

namespace microtrace {

struct HitGroup {
  HitLanes lanes{};  ///< valid for hits of mesh triangles that are in `sure`
  FlatHits flat_hits{};
  Lanes flat = 0;  ///< lanes with flat triangles, for which the arrays below are not set
  std::array<const TexturedMaterial*, kShadingLanes> looks{};
  std::array<PlacedMesh, kShadingLanes> meshes{};  ///< without arrays for other primitives
  std::array<std::array<std::uint32_t, 3>, kShadingLanes> corners{};
  Lanes hit = 0;   ///< lanes with a hit
  Lanes sure = 0;  ///< lanes whose points find_points() has computed
  Lanes with_attributes =
      0;  ///< lanes that may hold normals or texture coordinates other than zero
};

}  // namespace microtrace
