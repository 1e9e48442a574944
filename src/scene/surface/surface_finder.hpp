#pragma once
/// Computes surfaces at many hits.

#include "scene/kernels/kernel.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace microtrace {

/// Immutable; any number of threads may use it.
class SurfaceFinder {
 public:
  /// The primitives must outlive this object.
  explicit SurfaceFinder(const Primitives& primitives);

  using Hits = std::span<const std::optional<Hit>>;

  /// Sets batch.object and batch.primitive for each hit. `hits` has at most kSurfaceLanes elements.
  void find_ids(Hits hits, SurfaceBatch& batch) const;
  /// Sets all members of the batch for each hit, except for parts that are not selected. Values are
  /// those of interact(), rounded once.
  void find(std::span<const Ray> rays, Hits hits, const SurfaceParts& parts, SurfaceBatch& batch,
            const SceneKernels& kernels) const;
  /// Uses the kernels of best_instruction_set().
  void find(std::span<const Ray> rays, Hits hits, const SurfaceParts& parts,
            SurfaceBatch& batch) const;

 private:
  /// Calls visit(i, the hit object, index of the primitive in it) for each hit i.
  template <class Visit>
  static void for_each(const Primitives& primitives, Hits hits, const Visit& visit);

  const Primitives& primitives_;
  // The meshes of the scene's objects. There may be millions of placed meshes, whose arrays need a
  // transform; they have no elements. The first element stands for shapes without triangles.
  std::vector<MeshArrays> meshes_{{}};
  // By run of objects: indices into meshes_, or kPlaced. Ends with the last run that is not of
  // placed meshes.
  std::vector<std::uint32_t> mesh_of_run_;
};

}  // namespace microtrace
