#pragma once
/// From what kernels found to hits.

#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <optional>
#include <span>

namespace microtrace {

/// Up to kHitBatch rays and the primitives that they hit first, kNoPrimitive for none.
struct FoundHits {
  std::span<const Ray> rays;
  const std::uint32_t* ids;
  const float *o[3], *d[3];  ///< the rays' parts again, kHitBatch of each
};

/// hits[i] is ids[i] on rays[i] with t rounded once. The rays suit kernels.
void round_hits(const Primitives& primitives, const Kernels& kernels, const FoundHits& found,
                std::span<std::optional<Hit>> hits);

/// The same for the best hits of a tile of these rays.
void round_hits(const Primitives& primitives, const Kernels& kernels, const TreeView& tree,
                std::span<const Ray> rays, const KernelTile& tile,
                std::span<std::optional<Hit>> hits);

}  // namespace microtrace
