#pragma once
/// Computes spawned origins in float64 if the result is certain. The result nearly always is
/// certain, and float64 is much faster than exact arithmetic.

#include "accel/filters/triangle_filter.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/kernels/kernel.hpp"
#include "simd/vector_types.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <variant>

namespace microtrace {

/// The point where a ray hits a non-triangle surface, and the origins of rays that leave this
/// point. The results equal those of spawn_among.
class ShapeSpawn {
 public:
  /// `ray` must hit the surface.
  ShapeSpawn(const Plane& surface, const Ray& ray);
  ShapeSpawn(const Disc& surface, const Ray& ray);
  ShapeSpawn(const Sphere& surface, const Ray& ray);
  /// Not implemented for quadrics, for which point() returns nothing.
  ShapeSpawn(const Quadric& surface, const Ray& ray);

  /// Returns the rounded hit point, or nothing if float64 is too imprecise to determine it.
  [[nodiscard]] const std::optional<Vec3>& point() const { return p_; }
  /// Returns an upper bound, per axis, of the distances from the rounded point to the origins and
  /// to the exact point.
  [[nodiscard]] const DVec3& reach() const { return reach_; }
  /// Returns the surface's plane, if the surface is flat and axis-aligned.
  [[nodiscard]] std::optional<AxisPlane> axis_plane() const;

  /// Returns the origin, or nothing if float64 can't decide. The result is valid only if no other
  /// surface is near.
  [[nodiscard]] std::optional<Vec3> origin(const Vec3& direction) const;

 private:
  struct Flat {
    Vec3 a;
    CrossProduct normal;
  };
  struct Ball {
    Sphere sphere;
    DVec3 from_center, error;  ///< vector from the center to the exact point, error per axis
  };

  void set_flat(const Flat& flat, const Ray& ray);
  void set_reach(int steps);
  [[nodiscard]] std::optional<Vec3> origin(const Flat& flat, const Vec3& direction) const;
  [[nodiscard]] std::optional<Vec3> origin(const Ball& ball, const Vec3& direction) const;

  std::variant<std::monostate, Flat, Ball> surface_;
  std::optional<Vec3> p_;
  DVec3 reach_{0};
  int axis_ = 0;  // the axis along which origins are moved
};

/// The ray in a lane.
[[nodiscard]] Ray ray_of(const HitPointLanes& lanes, std::size_t lane);

/// Computes the origins of rays that leave several hits at a time.
class SpawnBatch {
 public:
  /// `unbounded` lists the primitives that are not in the tree. `tree` must be empty if the tree
  /// has no leaves.
  SpawnBatch(const Primitives& primitives, std::span<const PrimitiveId> unbounded,
             const Kernels& kernels, const SpawnKernels& spawn_kernels,
             const std::optional<TreeView>& tree)
      : primitives_(primitives),
        unbounded_(unbounded),
        kernels_(kernels),
        spawn_kernels_(spawn_kernels),
        tree_(tree) {}

  /// Computes the origins of some of the first spawns, at least one, and returns their number. An
  /// origin is empty if float64 can't decide it.
  std::size_t origins(std::span<const Bvh::Spawn> spawns, std::span<std::optional<Vec3>> origins);

  static constexpr std::size_t kHits = kBoxQueries;
  static_assert(kHits == kSpawnLanes);

  /// Instead of origins(): sets the hits that rays leave, one in each lane of `points`. The caller
  /// has set the rays of all hits, and the vertices of the lanes that are in `on_meshes`, which are
  /// triangles of meshes. `ids` must represent their duplicates. Finds what is near the hits.
  void set_hits(std::span<const PrimitiveId> ids, Lanes on_meshes, HitPointLanes& points);
  /// Computes the origins of rays that leave the `wanted` hits. Returns the lanes whose origins
  /// float64 can decide.
  [[nodiscard]] Lanes leave(Lanes wanted, OriginLanes& lanes) const;

 private:
  void add(PrimitiveId id, const Ray& ray);
  void put(const Triangle& triangle, const Ray& ray, std::size_t lane);
  void find_points();
  /// Sets the queries of hits on triangles, whose points the kernel has found.
  void set_queries();
  /// Sets the query of a hit on another surface.
  void set_query(std::size_t hit);
  /// The hit point, and the reach of ShapeSpawn or HitPointLanes.
  struct Place {
    DVec3 p, reach;
  };
  [[nodiscard]] Place place(std::size_t hit) const;
  /// Returns true if no primitive that the query has found, and none outside of the tree, is
  /// between the exact hit point and the origins.
  [[nodiscard]] bool is_alone(std::size_t hit) const;
  /// Returns the hits with results of their queries.
  [[nodiscard]] Lanes crowded() const;

  const Primitives& primitives_;
  std::span<const PrimitiveId> unbounded_;
  const Kernels& kernels_;
  const SpawnKernels& spawn_kernels_;
  const std::optional<TreeView> tree_;
  std::size_t hits_ = 0;
  Lanes triangles_ = 0;  // hits on triangles, which are in points_
  Lanes known_ = 0;      // hits whose points float64 can determine
  Lanes alone_ = 0;      // hits near which certainly no other surface obstructs rays
  std::array<std::optional<ShapeSpawn>, kHits> others_;  // hits on other surfaces
  std::array<std::size_t, kHits + 1> first_spawn_;       // index of each hit's first spawn
  BoxQueries queries_;  // omitted_id: the primitives that the rays leave
  HitPointLanes* points_ = nullptr;
  HitPointLanes own_points_{};
  OriginLanes origins_{};
};

}  // namespace microtrace
