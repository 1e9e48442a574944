#include "accel/resolve/packet_resolver.hpp"

namespace microtrace {
namespace {

void put(KernelPacket& packet, std::size_t i, const ClosestSoFar& best) {
  packet.best_lo[i] = best.lo;
  packet.best_hi[i] = best.hi;
  if (packet.best_id[i] != best.id) packet.best_slot[i] = kNoSlot;
  packet.best_id[i] = best.id;
}

}  // namespace

RayPacket& PacketResolver::rays_packet() {
  if (!packet_) packet_.emplace(*primitives_, rays_);
  return *packet_;
}

void PacketResolver::begin(KernelPacket& packet, std::span<const PrimitiveId> ids) {
  if (ids.empty()) return;
  for (const PrimitiveId id : ids)
    primitives_->visit(id, [&](const auto& shape) { rays_packet().test(id, shape); });
  for (std::size_t i = 0; i < rays_.size(); ++i) put(packet, i, rays_packet().best(i));
}

void PacketResolver::consider_all(std::uint32_t id, KernelPacket& packet) {
  const auto consider = [&](std::size_t i, const FilterResult& filtered) {
    if (filtered.certainty == Certainty::miss || filtered.lo > packet.best_hi[i] ||
        packet.best_id[i] == id)
      return;
    ClosestSoFar best{.lo = packet.best_lo[i], .hi = packet.best_hi[i], .id = packet.best_id[i]};
    if (filtered.certainty == Certainty::hit && filtered.hi < best.lo)
      best = outwards(filtered.lo, filtered.hi, id);
    else
      HitResolver(*primitives_, rays_[i]).consider(id, best);
    put(packet, i, best);
  };
  primitives_->visit(id,
                     [&](const auto& shape) { rays_packet().for_each_result(shape, consider); });
}

PacketFallback PacketResolver::fallback() {
  return {.context = this,
          .consider =
              [](void* context, int ray, std::uint32_t id, ClosestSoFar& best) {
                const auto* resolver = static_cast<const PacketResolver*>(context);
                HitResolver(*resolver->primitives_, resolver->rays_[static_cast<std::size_t>(ray)])
                    .consider(id, best);
              },
          .consider_all =
              [](void* context, std::uint32_t id, KernelPacket& packet) {
                static_cast<PacketResolver*>(context)->consider_all(id, packet);
              }};
}

}  // namespace microtrace
