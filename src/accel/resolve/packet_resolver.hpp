#pragma once
/// The stages that follow the float32 packet kernel, as HitResolver for several rays with a common
/// origin.

#include "accel/kernels/kernel.hpp"
#include "accel/ray_packet.hpp"
#include "accel/resolve/hit_resolver.hpp"

#include <optional>
#include <span>

namespace microtrace {

class PacketResolver {
 public:
  /// The rays must have a common origin. Both arguments must outlive this object.
  PacketResolver(const Primitives& primitives, std::span<const Ray> rays)
      : primitives_(&primitives), rays_(rays) {}

  /// Initializes the packet's nearest hits by testing these primitives.
  void begin(KernelPacket& packet, std::span<const PrimitiveId> ids);

  /// Returns callbacks for kernels. This object must outlive the result.
  [[nodiscard]] PacketFallback fallback();

 private:
  void consider_all(std::uint32_t id, KernelPacket& packet);
  RayPacket& rays_packet();

  const Primitives* primitives_;
  std::span<const Ray> rays_;
  std::optional<RayPacket> packet_;  // created on first use; most packets meet only triangles
};

}  // namespace microtrace
