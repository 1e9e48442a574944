#pragma once
/// Converts the results of kernels to hits with correctly rounded t.

#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

class PacketResolver;

/// Up to kHitBatch rays and the id of the first primitive that each ray hits, or kNoPrimitive for a
/// miss.
struct FoundHits {
  std::span<const Ray> rays;
  const std::uint32_t* ids;
  const float *o[3], *d[3];  ///< origins and directions, in arrays of kHitBatch elements
};

/// Sets hits[i] to the hit of rays[i] with primitive ids[i], with t rounded once.
/// The rays must be within the kernels' limits.
void round_hits(const Primitives& primitives, const Kernels& kernels, const FoundHits& found,
                std::span<std::optional<Hit>> hits);

/// Sets the hit of each ray of a packet to its nearest one.
void round_hits(const PacketResolver& resolver, const Kernels& kernels, const KernelPacket& packet,
                std::span<std::optional<Hit>> hits);

}  // namespace microtrace
