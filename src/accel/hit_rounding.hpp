#pragma once
/// Converts the results of kernels to hits.

#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <optional>
#include <span>

namespace microtrace {

/// Up to kHitBatch rays and the first primitive that each hits; kNoPrimitive for a miss.
struct FoundHits {
  std::span<const Ray> rays;
  const std::uint32_t* ids;
  const float *o[3], *d[3];  ///< components of the rays, in arrays of kHitBatch elements
};

/// Sets hits[i] to the hit of rays[i] with primitive ids[i], with t rounded once. The rays are
/// within the kernels' limits.
void round_hits(const Primitives& primitives, const Kernels& kernels, const FoundHits& found,
                std::span<std::optional<Hit>> hits);

/// The same for the nearest hits of a packet of rays.
void round_hits(const Primitives& primitives, const Kernels& kernels, const TreeView& tree,
                std::span<const Ray> rays, const KernelPacket& packet,
                std::span<std::optional<Hit>> hits);

}  // namespace microtrace
