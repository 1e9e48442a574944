#pragma once
/// The stages that follow the float32 packet kernel, as HitResolver for several rays with a common
/// origin.

#include "accel/kernels/kernel.hpp"
#include "accel/resolve/hit_resolver.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace microtrace {

class PacketResolver {
 public:
  /// The rays must be those of the packet, which must not have any hits yet. They pass through open
  /// sides. All arguments must outlive this object.
  PacketResolver(const Primitives& primitives, const Kernels& kernels, const OpenSide& open,
                 std::span<const Ray> rays, const KernelPacket& packet);

  /// Considers primitive `id` for all rays.
  void consider_all(PrimitiveId id, KernelPacket& packet);

  /// Returns callbacks for kernels. This object must outlive the result.
  [[nodiscard]] PacketFallback fallback();

  /// Returns the hit of the ray at place i with primitive `id`, which must be its nearest one, with
  /// t rounded once.
  [[nodiscard]] Hit hit(std::size_t i, PrimitiveId id) const;

 private:
  [[nodiscard]] const Ray& ray_at(std::size_t i) const { return rays_[order_[i]]; }
  /// Considers primitive `id` for the ray at place i.
  void consider(std::size_t i, PrimitiveId id, ClosestSoFar& best) const;

  const Primitives* primitives_;
  const ShapeKernels* kernels_;
  OpenSide open_;
  std::span<const Ray> rays_;
  const std::uint8_t* order_;
  ShapeBounds bounds_;
};

}  // namespace microtrace
