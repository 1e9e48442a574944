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
  struct Entry {
    MeshArrays mesh;     // positions is null for shapes without triangles
    const Mesh* placed;  // a placed mesh, whose arrays need a transform; otherwise null
    PrimitiveId first_id, count;
  };

  /// Calls visit(i, entry of the hit object, primitive id) for each hit i.
  template <class Visit>
  void for_each(Hits hits, const Visit& visit) const;

  const Primitives& primitives_;
  std::vector<Entry> entries_;  // by object
};

}  // namespace microtrace
