#pragma once
#include "render/lanes/flat_lanes.hpp"
#include "simd/vector_types.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

struct TexturedMaterial;

/// The triangles of a scene that kernels can load without looking at meshes and materials, if they
/// are so few that they fit into the fast caches.
class FlatTriangles {
 public:
  /// Adds the surface of the next material.
  void add_surface(const TexturedMaterial& look);
  /// Adds the triangles of a mesh if they are flat. `first` is the number of the first primitive,
  /// and `surface` the number of its material.
  void add_mesh(const PlacedMesh& placed, PrimitiveId first, std::uint32_t surface,
                const TexturedMaterial& look);

  /// Sets hits.rows to the rows of the primitives in these lanes. Returns the lanes with flat
  /// triangles.
  [[nodiscard]] Lanes find(std::span<const PrimitiveId, kShadingLanes> ids, Lanes lanes,
                           FlatHits& hits) const;

  [[nodiscard]] const FlatTriangle* triangles() const { return triangles_.data(); }
  [[nodiscard]] const FlatSurface* surfaces() const { return surfaces_.data(); }

 private:
  static constexpr std::size_t kMostTriangles = std::size_t{1} << 14U;
  static constexpr std::size_t kMostPrimitives = std::size_t{1} << 18U;

  std::vector<FlatTriangle> triangles_;  // the first one stands for all that are not flat
  std::vector<FlatSurface> surfaces_;
  std::vector<std::uint32_t> rows_;  // by primitive, up to the last flat one; 0 for others
};

}  // namespace microtrace
