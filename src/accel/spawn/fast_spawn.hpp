#pragma once
/// Computes spawned origins in float64 alone if the result is certain. It nearly always is, and
/// this is much faster than exact arithmetic.

#include "accel/filters/triangle_filter.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/kernels/kernel.hpp"

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

/// The point where a ray hits a surface other than a triangle, and origins of rays that leave it.
/// The answers equal those of spawn_among.
class FastSpawn {
 public:
  /// `ray` must hit the surface.
  FastSpawn(const Plane& surface, const Ray& ray);
  FastSpawn(const Disc& surface, const Ray& ray);
  FastSpawn(const Sphere& surface, const Ray& ray);
  /// Not implemented for quadrics: the result is never certain.
  FastSpawn(const Quadric& surface, const Ray& ray);

  /// The rounded point; nothing if it is too imprecise to search its neighborhood.
  [[nodiscard]] const std::optional<Vec3>& point() const { return p_; }
  /// Upper bound of the distance from the rounded point to origins and to the exact point, per
  /// axis.
  [[nodiscard]] const DVec3& reach() const { return reach_; }
  /// The surface's plane, if it is axis-aligned.
  [[nodiscard]] std::optional<AxisPlane> axis_plane() const;

  /// Nothing if float64 can't decide. Valid only if no other surface is near.
  [[nodiscard]] std::optional<Vec3> origin(const Vec3& direction) const;

 private:
  struct Flat {
    Vec3 a;
    CrossProduct normal;
  };
  struct Ball {
    Sphere sphere;
    DVec3 from_center, error;  ///< vector to the exact point, with its error per axis
  };

  void set_flat(const Flat& flat, const Ray& ray);
  void set_reach(int steps);
  [[nodiscard]] std::optional<Vec3> origin(const Flat& flat, const Vec3& direction) const;
  [[nodiscard]] std::optional<Vec3> origin(const Ball& ball, const Vec3& direction) const;

  std::variant<std::monostate, Flat, Ball> surface_;
  std::optional<Vec3> p_;
  DVec3 reach_{0};
  int axis_ = 0;  // axis along which origins are moved
};

/// Computes the origins of several hits at a time.
class FastSpawns {
 public:
  /// `outside` lists the primitives that are not in the tree. A tree without leaves is not passed.
  FastSpawns(const Primitives& primitives, std::span<const PrimitiveId> outside,
             const Kernels& kernels, const SpawnKernels& spawn_kernels,
             const std::optional<TreeView>& tree)
      : primitives_(primitives),
        outside_(outside),
        kernels_(kernels),
        spawn_kernels_(spawn_kernels),
        tree_(tree) {}

  /// Computes a number of origins from the front, at least one if there are any, and returns this
  /// number. An origin is empty if only exact arithmetic can find it.
  std::size_t origins(std::span<const Bvh::Spawn> spawns, std::span<std::optional<Vec3>> origins);

 private:
  static constexpr std::size_t kHits = kBoxQueries;
  static_assert(kHits == kSpawnLanes);

  /// A surface that rays leave.
  struct LeftSurface {
    PrimitiveId id;
    bool is_triangle;                ///< whether hit_points_ holds it, at the index of the hit
    bool is_known;                   ///< whether float64 can determine the hit point
    bool is_alone;                   ///< no other surface is between the point and the origins
    std::optional<FastSpawn> other;  ///< for surfaces other than triangles
  };

  void add(const Bvh::Spawn& spawn);
  void put(const Triangle& triangle, const Ray& ray, std::size_t lane);
  void set_query(std::size_t hit);
  void find_neighbors();
  [[nodiscard]] bool is_alone(std::size_t hit) const;
  void leave_triangles(std::span<const Bvh::Spawn> spawns, std::span<std::optional<Vec3>> origins);

  const Primitives& primitives_;
  std::span<const PrimitiveId> outside_;
  const Kernels& kernels_;
  const SpawnKernels& spawn_kernels_;
  const std::optional<TreeView> tree_;
  std::size_t hits_ = 0;
  std::array<LeftSurface, kHits> surfaces_;
  std::array<std::size_t, kHits + 1> first_spawn_;  // of each hit
  std::array<BoxQuery, kHits> queries_;
  HitPointLanes hit_points_{};
  OriginLanes origins_{};
};

}  // namespace microtrace
