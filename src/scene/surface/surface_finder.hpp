#pragma once
/// Surfaces at many hits.

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

  /// Sets batch.object and batch.primitive of each hit. There are at most kSurfaceLanes.
  void find_ids(Hits hits, SurfaceBatch& batch) const;
  /// Sets all members of each hit but parts that are not asked for: interact(), rounded once.
  void find(std::span<const Ray> rays, Hits hits, const SurfaceParts& parts, SurfaceBatch& batch,
            const SceneKernels& kernels) const;
  /// With the kernels of best_instruction_set().
  void find(std::span<const Ray> rays, Hits hits, const SurfaceParts& parts,
            SurfaceBatch& batch) const;

 private:
  struct Entry {
    MeshArrays mesh;  // without positions: another shape
    PrimitiveId first_id, count;
  };

  const Primitives& primitives_;
  std::vector<Entry> entries_;  // by object
};

}  // namespace microtrace
