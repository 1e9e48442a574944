#include "accel/hit_rounding.hpp"

#include "accel/packet_order.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "accel/resolve/packet_resolver.hpp"

#include <algorithm>
#include <bit>

namespace microtrace {
namespace {

// Looks up triangle vertices by primitive id. Keeps the last mesh, because consecutive hits are
// mostly on the same mesh.
class CornerFinder {
 public:
  explicit CornerFinder(const Primitives& primitives) : primitives_(&primitives) {}

  /// Prefetch the data that put() reads: first a triangle's indices, then its vertices.
  void fetch_indices(PrimitiveId id) {
    if (finds_mesh(id)) __builtin_prefetch(&object_.mesh.arrays->triangles[id - object_.first_id]);
  }
  void fetch_vertices(PrimitiveId id) {
    if (!finds_mesh(id)) return;
    const Mesh& mesh = *object_.mesh.arrays;
    for (const std::uint32_t corner : mesh.triangles[id - object_.first_id])
      __builtin_prefetch(&mesh.positions[corner]);
  }

  /// Returns false if the primitive is not a mesh triangle.
  bool put(PrimitiveId id, HitBatch& batch, std::size_t i) {
    if (!finds_mesh(id)) return false;
    const Triangle triangle = triangle_of(object_.mesh, id - object_.first_id);
    put(batch.a, i, triangle.a);
    put(batch.b, i, triangle.b);
    put(batch.c, i, triangle.c);
    return true;
  }

 private:
  bool finds_mesh(PrimitiveId id) {
    if (id < object_.first_id || id >= object_.end_id) object_ = primitives_->object_of(id);
    return static_cast<bool>(object_.mesh);
  }

  static void put(float (&column)[3][kHitBatch], std::size_t i, const Vec3& v) {
    column[0][i] = v.x;
    column[1][i] = v.y;
    column[2][i] = v.z;
  }

  const Primitives* primitives_;
  PlacedObject object_{};  // that was looked up last
};

/// Calls f(i) for each bit of the set. Unlike a branch for each element, a loop over a set is
/// mispredicted only once.
template <class F>
void for_each_bit(std::uint64_t set, const F& f) {
  for (; set != 0; set &= set - 1) f(static_cast<std::size_t>(std::countr_zero(set)));
}

/// Returns the elements that are not kNoPrimitive, one bit each.
std::uint64_t found_of(std::span<const std::uint32_t> ids) {
  std::uint64_t result = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) result |= std::uint64_t{ids[i] != kNoPrimitive} << i;
  return result;
}

/// The set of the first `count` elements.
std::uint64_t all_of(std::size_t count) {
  return ~std::uint64_t{0} >> (kHitBatch - count);
}

struct RoundedT {
  std::uint64_t certain;  // one bit per ray, set if t is certainly the rounded exact value
  const float* t;
};

// Writes the hits. `found` are the elements of `ids` that are not kNoPrimitive. resolve(i, id) must
// return the hit of element i's ray with primitive `id`.
template <class Resolve>
void write_hits(const std::uint32_t* ids, std::uint64_t found, const std::uint8_t* order,
                const RoundedT& rounded, const Resolve& resolve,
                std::span<std::optional<Hit>> hits) {
  for_each_bit(all_of(hits.size()) & ~found, [&](std::size_t i) { hits[order[i]].reset(); });
  for_each_bit(found & rounded.certain,
               [&](std::size_t i) { hits[order[i]] = Hit{.id = ids[i], .t = rounded.t[i]}; });
  for_each_bit(found & ~rounded.certain,
               [&](std::size_t i) { hits[order[i]] = resolve(i, ids[i]); });
}

}  // namespace

void round_hits(const Primitives& primitives, const Kernels& kernels, const FoundHits& found,
                std::span<std::optional<Hit>> hits) {
  const std::size_t count = found.rays.size();
  HitBatch batch;
  std::copy_n(found.o, 3, batch.o);
  std::copy_n(found.d, 3, batch.d);
  CornerFinder corners(primitives);
  std::uint64_t triangles = 0;  // one bit per ray that hits a mesh triangle
  const std::uint64_t hit = found_of({found.ids, count});
  const auto for_each_hit = [&](const auto& f) {
    for_each_bit(hit, [&](std::size_t i) { f(i, found.ids[i]); });
  };
  // The hits of incoherent rays are far apart in memory.
  for_each_hit([&](std::size_t, PrimitiveId id) { corners.fetch_indices(id); });
  for_each_hit([&](std::size_t, PrimitiveId id) { corners.fetch_vertices(id); });
  for_each_hit([&](std::size_t i, PrimitiveId id) {
    if (corners.put(id, batch, i)) triangles |= std::uint64_t{1} << i;
  });
  const std::uint64_t certain = triangles != 0 ? kernels.round_t(batch) & triangles : 0;
  const auto resolve = [&](std::size_t i, PrimitiveId id) {
    return HitResolver(primitives, found.rays[i]).hit(id);
  };
  write_hits(found.ids, hit, kGivenOrder.data(), {.certain = certain, .t = batch.t}, resolve,
             hits.first(count));
}

void round_hits(const PacketResolver& resolver, const Kernels& kernels, const KernelPacket& packet,
                std::span<std::optional<Hit>> hits) {
  alignas(64) float t[kPacketRays];
  const std::uint64_t certain = kernels.round_t_of_packet(packet, t);
  const std::uint64_t all = all_of(hits.size());
  if ((certain & all) == all) {  // as for most packets
    for (std::size_t i = 0; i < hits.size(); ++i)
      hits[packet.order[i]] = Hit{.id = packet.best_id[i], .t = t[i]};
    return;
  }
  const auto resolve = [&](std::size_t i, PrimitiveId id) { return resolver.hit(i, id); };
  write_hits(packet.best_id, found_of({packet.best_id, hits.size()}), packet.order,
             {.certain = certain, .t = t}, resolve, hits);
}

}  // namespace microtrace
