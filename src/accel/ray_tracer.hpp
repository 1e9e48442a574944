#pragma once
/// Queries of a Bvh for rays in arrays of components. The results are those of the functions of
/// Bvh.

#include "accel/ray_stream.hpp"
#include "accel/spawn/shape_spawn.hpp"

#include <microtrace/bvh.hpp>

#include <memory>
#include <optional>
#include <span>

namespace microtrace {

/// A tracer of rays for one thread. It holds large working memory.
class RayTracer {
 public:
  RayTracer();
  ~RayTracer();
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;

  /// True if rays can pass through open sides, which isn't the case if triangles coincide.
  [[nodiscard]] bool knows_sides() const;
  /// The sides that intersect_fronts() passes through for these `backs`.
  [[nodiscard]] OpenSide open_backs(BitPages backs) const;

  /// Selects the Bvh, which must outlive the following queries.
  void begin(const Bvh& bvh);

  /// Set ids[i] to the primitive that ray i hits first, or to any primitive that it hits, or to
  /// kNoPrimitive. Only hits that `filter` selects count.
  void closest(const RayColumns& rays, const HitFilter& filter, std::span<PrimitiveId> ids);
  void any(const RayColumns& rays, const HitFilter& filter, std::span<PrimitiveId> ids);

  /// The hit of a ray with the primitive that closest() found.
  [[nodiscard]] Hit hit(const Ray& ray, PrimitiveId id) const;
  /// True if a ray hits primitive `id` before `other`. It must hit both.
  [[nodiscard]] bool is_first(const Ray& ray, PrimitiveId id, PrimitiveId other) const;

  /// Sets the hits that rays leave, one in each lane of `points`; see SpawnBatch::set_hits. There
  /// may be at most kSpawnLanes. `points` must remain valid for leave().
  void set_hits(std::span<const PrimitiveId> ids, Lanes on_meshes, HitPointLanes& points);
  /// Sets the origins of rays that leave the `wanted` hits in the directions of `lanes`, as
  /// Bvh::spawn_origin does. Returns the lanes for which there is an origin.
  [[nodiscard]] Lanes leave(Lanes wanted, OriginLanes& lanes);

 private:
  /// Calls query(rays, ids, ask_one) for parts of the rays, which the stream can trace.
  template <class Query>
  void trace(const RayColumns& rays, const HitFilter& filter, std::span<PrimitiveId> ids,
             const Query& query);

  struct Queries;  // for one Bvh
  struct Memory;   // for the queries of any Bvh
  [[nodiscard]] Queries& queries() const;

  std::unique_ptr<Memory> memory_;
};

}  // namespace microtrace
