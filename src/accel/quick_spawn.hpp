#pragma once
/// Spawned origins by float64 alone, where that is sure: nearly always, and much sooner.

#include "accel/filters/triangle_filter.hpp"
#include "accel/kernels/kernel.hpp"

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

struct SharedCoordinates;

/// The point where a ray hits a surface, for rays that leave it. Answers are spawn_among's.
class QuickSpawn {
 public:
  /// `ray` hits the surface, which bears that number.
  QuickSpawn(const Triangle& surface, PrimitiveId id, const Ray& ray);
  QuickSpawn(const Plane& surface, PrimitiveId id, const Ray& ray);
  QuickSpawn(const Disc& surface, PrimitiveId id, const Ray& ray);
  QuickSpawn(const Sphere& surface, PrimitiveId id, const Ray& ray);
  /// Not sure of anything.
  QuickSpawn(const Quadric& surface, PrimitiveId id, const Ray& ray);

  /// Whether the point is known well enough to look at what is near.
  [[nodiscard]] bool is_sure() const { return p_.has_value(); }
  /// The box in which another surface might come between the point and an origin.
  void set_box(PlaceQuery& query) const;
  /// Whether it is sure that none of the tree does, by what was found in the box, nor any of the
  /// others. Origins are good only then.
  [[nodiscard]] bool is_alone(const Primitives& primitives, std::span<const PrimitiveId> outside,
                              const TreeView& tree, const PlaceQuery& found) const;

  /// Nothing if float64 can't tell.
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

  void set_flat(const Flat& flat, const SharedCoordinates& shared, const Ray& ray);
  [[nodiscard]] bool is_passed_by(const Primitives& primitives, PrimitiveId id) const;
  [[nodiscard]] std::optional<Vec3> origin(const Flat& flat, const Vec3& direction) const;
  [[nodiscard]] std::optional<Vec3> origin(const Ball& ball, const Vec3& direction) const;

  std::variant<std::monostate, Flat, Ball> surface_;
  PrimitiveId id_;
  std::optional<Vec3> p_;  // rounded; nothing: not sure
  double reach_ = 0;       // origins lie so near to p_, axis by axis
  int axis_ = 0;           // along which origins are moved
};

/// Several hits at a time.
class QuickSpawns {
 public:
  /// `outside` names the primitives that are not in the tree.
  QuickSpawns(const Primitives& primitives, std::span<const PrimitiveId> outside,
              const Kernels& kernels, const TreeView& tree)
      : primitives_(primitives), outside_(outside), kernels_(kernels), tree_(tree) {}

  /// Answers spawns from the front, at least one if there is any, and returns how many. Nothing
  /// stands for what only exact arithmetic can tell.
  std::size_t origins(std::span<const Bvh::Spawn> spawns, std::span<std::optional<Vec3>> origins);

 private:
  const Primitives& primitives_;
  std::span<const PrimitiveId> outside_;
  const Kernels& kernels_;
  const TreeView tree_;
  std::array<PlaceQuery, kPlaceQueries> queries_;
};

}  // namespace microtrace
