#pragma once
/// Visits the vertices of many placements of a mesh without reading all of them each time.

#include "scene/mesh/shared_meshes.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <vector>

namespace microtrace {

/// The bounding boxes of consecutive vertices of a mesh, in the mesh's own space. Vertices that are
/// not finite are in no box.
class MeshChunks {
 public:
  explicit MeshChunks(const Mesh& mesh);

  /// A box in scene coordinates; empty if lo > hi.
  struct Box {
    Vec3 lo, hi;
  };

  /// Calls point(p) for all vertices of a placed mesh, in scene coordinates, except for chunks for
  /// whose box skips(box) is true. The box contains all finite vertices of the chunk. Begins with
  /// the chunks that reach farthest along each axis, after which most others can be skipped,
  /// unless there are only a few. May visit a chunk twice.
  template <class Skips, class Point>
  void visit(const PlacedMesh& mesh, const Skips& skips, const Point& point) const {
    const std::vector<Box> boxes = placed(*mesh.placement);
    const auto visit_chunk = [&](std::size_t i) {
      if (!(boxes[i].lo.x <= boxes[i].hi.x) || skips(boxes[i])) return;
      const std::size_t end = std::min(mesh.arrays->positions.size(), (i + 1) * kSize);
      for (std::size_t k = i * kSize; k < end; ++k) point(mesh.position(k));
    };
    constexpr std::size_t kFew = 6;
    if (boxes.size() > kFew)
      for (const std::size_t i : farthest(boxes)) visit_chunk(i);
    for (std::size_t i = 0; i < boxes.size(); ++i) visit_chunk(i);
  }

 private:
  static constexpr std::size_t kSize = 64;  // number of vertices

  [[nodiscard]] std::vector<Box> placed(const Placement& placement) const;
  /// Returns the indices of the boxes with the least and the greatest coordinate on each axis.
  [[nodiscard]] static std::vector<std::size_t> farthest(const std::vector<Box>& boxes);

  std::vector<Box> boxes_;
};

/// The chunks of the meshes of a scene, made on first use. The meshes must outlive this object.
class ChunkedMeshes {
 public:
  [[nodiscard]] const MeshChunks& of(const Mesh& mesh) {
    return chunks_.try_emplace(ArrayKey(mesh.positions), mesh).first->second;
  }

 private:
  std::unordered_map<ArrayKey, MeshChunks, ArrayKey::Hash> chunks_;  // by the positions
};

}  // namespace microtrace
