#pragma once
/// Spawned origins by float64 alone, where that is sure: nearly always, and much sooner.

#include "accel/filters/triangle_filter.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/spawn/kernels/kernel.hpp"
#include "accel/spawn/passing.hpp"

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

/// The point where a ray hits a surface other than a triangle, for rays that leave it. Answers are
/// spawn_among's.
class QuickSpawn {
 public:
  /// `ray` hits the surface.
  QuickSpawn(const Plane& surface, const Ray& ray);
  QuickSpawn(const Disc& surface, const Ray& ray);
  QuickSpawn(const Sphere& surface, const Ray& ray);
  /// Not sure of anything.
  QuickSpawn(const Quadric& surface, const Ray& ray);

  /// Rounded; nothing if it is not known well enough to look at what is near.
  [[nodiscard]] const std::optional<Vec3>& point() const { return p_; }
  /// Origins and the exact point lie so near to it, axis by axis.
  [[nodiscard]] const DVec3& reach() const { return reach_; }
  /// That of the surface, if it has one.
  [[nodiscard]] std::optional<AxisPlane> axis_plane() const;

  /// Nothing if float64 can't tell. Good only where no other surface comes between.
  [[nodiscard]] std::optional<Vec3> origin(const Vec3& direction) const;

 private:
  struct Flat {
    Vec3 a;
    CrossProduct normal;
  };
  struct Ball {
    Sphere sphere;
    DVec3 from_center, error;  ///< to the exact point, and how far off axis by axis
  };

  void set_flat(const Flat& flat, const Ray& ray);
  void set_reach(int steps);
  [[nodiscard]] std::optional<Vec3> origin(const Flat& flat, const Vec3& direction) const;
  [[nodiscard]] std::optional<Vec3> origin(const Ball& ball, const Vec3& direction) const;

  std::variant<std::monostate, Flat, Ball> surface_;
  std::optional<Vec3> p_;
  DVec3 reach_{0};
  int axis_ = 0;  // along which origins are moved
};

/// Several hits at a time.
class QuickSpawns {
 public:
  /// `outside` names the primitives that are not in the tree. Without leaves there is no tree.
  QuickSpawns(const Primitives& primitives, std::span<const PrimitiveId> outside,
              const Kernels& kernels, const SpawnKernels& spawn_kernels,
              const std::optional<TreeView>& tree)
      : primitives_(primitives),
        outside_(outside),
        kernels_(kernels),
        spawn_kernels_(spawn_kernels),
        tree_(tree) {}

  /// Answers spawns from the front, at least one if there is any, and returns how many. Nothing
  /// stands for what only exact arithmetic can tell.
  std::size_t origins(std::span<const Bvh::Spawn> spawns, std::span<std::optional<Vec3>> origins);

 private:
  static constexpr std::size_t kHits = kPlaceQueries;
  static constexpr std::size_t kSpawns = 4 * kHits;
  static_assert(kHits == kSpawnLanes);

  /// A surface that rays leave, where float64 is sure of the point.
  struct Departure {
    PrimitiveId id;
    bool is_triangle;                 ///< its place in departures_ is that among the hits
    std::optional<QuickSpawn> other;  ///< if it is none
    bool is_alone;                    ///< no other surface comes between the point and origins
  };

  void add(const Bvh::Spawn& spawn);
  void put(const Triangle& triangle, const Ray& ray, std::size_t lane);
  void find_neighbours();
  [[nodiscard]] std::optional<AxisPlane> axis_plane_of(std::size_t hit) const;
  [[nodiscard]] bool is_alone(std::size_t hit, const Vec3& p, const DVec3& reach) const;
  void put(std::size_t hit, const Vec3& direction, std::size_t lane);
  void leave_triangles(std::span<const Bvh::Spawn> spawns, std::span<std::optional<Vec3>> origins);

  const Primitives& primitives_;
  std::span<const PrimitiveId> outside_;
  const Kernels& kernels_;
  const SpawnKernels& spawn_kernels_;
  const std::optional<TreeView> tree_;
  std::size_t hits_ = 0;
  std::array<Departure, kHits> surfaces_;
  std::array<std::size_t, kSpawns> hit_of_;  // for each spawn
  std::array<PlaceQuery, kHits> queries_;
  DepartureLanes departures_{};
  OriginLanes origins_{};
};

}  // namespace microtrace
