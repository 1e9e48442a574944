#include "accel/resolve/packet_resolver.hpp"

#include "accel/filters/shape_filter.hpp"
#include "accel/resolve/open_side.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

namespace microtrace {
namespace {

void put(KernelPacket& packet, std::size_t i, const ClosestSoFar& best) {
  packet.best_lo[i] = best.lo;
  packet.best_hi[i] = best.hi;
  if (packet.best_id[i] != best.id) packet.best_index[i] = PacketHits::kNone;
  packet.best_id[i] = best.id;
}

auto kernel_for(const ShapeKernels& kernels, const Plane&) {
  return kernels.plane;
}
auto kernel_for(const ShapeKernels& kernels, const Disc&) {
  return kernels.disc;
}
auto kernel_for(const ShapeKernels& kernels, const Sphere&) {
  return kernels.sphere;
}
auto kernel_for(const ShapeKernels& kernels, const Quadric&) {
  return kernels.quadric;
}

}  // namespace

PacketResolver::PacketResolver(const Primitives& primitives, const Kernels& kernels,
                               const OpenSide& open, std::span<const Ray> rays,
                               const KernelPacket& packet)
    : primitives_(&primitives),
      kernels_(&kernels.shapes),
      open_(open),
      rays_(rays),
      order_(packet.order) {
  std::ranges::fill(bounds_.id, kNoPrimitive);
  std::ranges::copy(packet.best_hi, bounds_.t_max);
}

void PacketResolver::consider(std::size_t i, PrimitiveId id, ClosestSoFar& best) const {
  const Ray& ray = ray_at(i);
  if (!meets_open_side(*primitives_, open_, ray, id))
    HitResolver(*primitives_, ray).consider(id, best);
}

void PacketResolver::consider_all(PrimitiveId id, KernelPacket& packet) {
  const auto consider_one = [&](std::size_t i) {
    ClosestSoFar best{.lo = packet.best_lo[i], .hi = packet.best_hi[i], .id = packet.best_id[i]};
    consider(i, id, best);
    put(packet, i, best);
  };
  primitives_->visit(id, [&]<class AnyShape>(const AnyShape& shape) {
    if constexpr (!std::is_same_v<AnyShape, Triangle>) {
      // The packet's rays are within narrower limits than those of the filters.
      if (is_filterable(shape)) {
        const auto seen = seen_from(rays_[0].o, shape).shape;
        std::uint64_t open = kernel_for(*kernels_, shape)(seen, id, packet, bounds_);
        for (; open != 0; open &= open - 1)
          consider_one(static_cast<std::size_t>(std::countr_zero(open)));
        return;
      }
    }
    for (std::size_t i = 0; i < rays_.size(); ++i) consider_one(i);
  });
}

PacketFallback PacketResolver::fallback() {
  return {.context = this,
          .consider =
              [](void* context, int ray, std::uint32_t id, ClosestSoFar& best) {
                static_cast<const PacketResolver*>(context)->consider(static_cast<std::size_t>(ray),
                                                                      id, best);
              },
          .consider_all =
              [](void* context, std::uint32_t id, KernelPacket& packet) {
                static_cast<PacketResolver*>(context)->consider_all(id, packet);
              }};
}

Hit PacketResolver::hit(std::size_t i, PrimitiveId id) const {
  const auto t = exact::rounded({.lo = bounds_.lo[i], .hi = bounds_.hi[i]});
  if (bounds_.id[i] == id && t) return {.id = id, .t = *t};
  return HitResolver(*primitives_, ray_at(i)).hit(id);
}

}  // namespace microtrace
