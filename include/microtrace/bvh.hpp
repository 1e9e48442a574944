#pragma once
/// Finds the nearest hits of rays with a scene by a bounding volume hierarchy (BVH).

#include <microtrace/export.hpp>
#include <microtrace/frustum.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace microtrace {

/// A closed, axis-aligned box.
struct Box {
  Vec3 lo, hi;
};

struct BitPage;

/// The tree of a Bvh. It doesn't refer to the scene, but holds copies of the arrays of meshes that
/// objects share (see Array), which recognize these meshes in a later scene.
struct BvhTree;

struct BvhOptions {
  bool fast_build = false;  ///< faster build and slower tracing, for previews
  unsigned threads = 0;     ///< number of threads for the build; 0: default_threads()
  /// Bvh::tree() of a scene with the same primitives at different positions, such as the previous
  /// frame of an animation. Refitting the boxes of this tree to the new positions takes about half
  /// of the time of a build. A new tree is built if the primitives differ, or if the cost of the
  /// refitted tree would exceed max_cost_growth times the cost when the tree was built. The cost is
  /// the surface area heuristic's estimate for a ray, relative to the area of the primitives'
  /// boxes.
  std::shared_ptr<const BvhTree> previous{};
  double max_cost_growth = 1.2;
};

/// An exact ray intersector for one scene. Immutable; may be used by any number of threads.
///
/// Every query returns the hit with the least (t, PrimitiveId), as if computed in real arithmetic
/// from the float32 numbers of the scene and the ray. The result does not depend on options, the
/// instruction set, the order of work or the function used; see docs/exactness.md. Rays and results
/// are in scene coordinates (see Scene::origin).
class MICROTRACE_EXPORT Bvh {
 public:
  /// Builds the tree. The scene must outlive this object and must not change. Throws Error (limit)
  /// if memory runs out or the scene has too many primitives.
  explicit Bvh(const Scene& scene, BvhOptions options = {});
  explicit Bvh(const Scene&& scene, BvhOptions options = {}) = delete;  // would dangle
  ~Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  /// Returns the nearest hit; nothing if the ray hits nothing or is invalid (see Ray).
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;

  /// Returns the hit that follows `after` in the order (t, PrimitiveId) of the ray's hits. Repeated
  /// calls enumerate all hits, nearest first, including several at the same t. Each primitive
  /// counts once, with its first hit in [t_min, t_max]; even a sphere is returned only once. Only
  /// the id of `after` is used, because its exact t is computed again. Returns nothing after the
  /// last hit, or if the ray does not hit the primitive of `after`.
  [[nodiscard]] std::optional<Hit> next(const Ray& ray, const Hit& after) const;

  /// Returns the origin of a new ray that leaves the hit of `ray` in `direction` (any nonzero
  /// length). Like spawn_origin in spawn.hpp, but also takes other surfaces into account. All
  /// guarantees stated there hold except the one on distance: the origin may be about 2^10 float32
  /// steps away from the hit point.
  ///
  /// Let w be the point of `ray` just before the hit if the new ray returns to that side of the
  /// surface, otherwise the point just behind the hit. The segment from w to the origin, excluding
  /// w, meets no triangle of nonzero area, no disc and no plane. The origin is on the same side of
  /// each sphere and quadric as w. A path therefore leaves a closed mesh only by transmission
  /// through a surface, never by accident in a crease or corner. Exceptions:
  ///
  /// - If `ray` runs within a flat surface, w lies on that surface, and the origin may be on either
  ///   side of it.
  /// - The segment may cross triangles of zero area.
  /// - If `ray` only touches a sphere or quadric, both points are outside of it; a new ray to the
  ///   inside starts inside.
  ///
  /// Returns nothing if no such float32 point exists because the surrounding surfaces are too close
  /// together. The result does not depend on BvhOptions, and no coordinate is -0. The new ray may
  /// have t_min = 0.
  [[nodiscard]] std::optional<Vec3> spawn_origin(const Ray& ray, const Hit& hit,
                                                 const Vec3& direction) const;

  /// A ray that leaves a hit.
  struct Spawn {
    const Ray* ray;  ///< the ray of the hit
    Hit hit;         ///< a hit of this ray, as returned by intersect and next
    Vec3 direction;  ///< direction of the new ray, any nonzero length
  };

  /// Sets origins[i] to the result of spawn_origin for spawns[i], bit for bit, however the spawns
  /// are divided into calls. Both spans must have the same size. Much faster than single calls,
  /// especially if spawns that leave the same hit are consecutive.
  void spawn_origins(std::span<const Spawn> spawns, std::span<std::optional<Vec3>> origins) const;

  /// Returns true if no surface meets any segment between two points that differ from p by at most
  /// one float32 step in each coordinate; the step of a power of two is the one above it. A point
  /// on a ray may therefore be rounded to p without crossing a surface. Exact for triangles. Uses
  /// float64 with error bounds for other shapes, so it may return false next to one that meets no
  /// such segment. The result does not depend on BvhOptions.
  [[nodiscard]] bool is_clear(const Vec3& p) const;

  /// Returns true if the ray hits anything. Faster than intersect.
  [[nodiscard]] bool occluded(const Ray& ray) const;

  /// Sets hits[i] to the nearest hit of rays[i]. Both spans must have the same size. Faster than
  /// single calls, and fastest if consecutive rays are coherent and share an origin, such as the
  /// rays of neighboring pixels.
  ///
  /// `left` must be empty or have the same size. If it is not empty, each rays[i] must leave a hit
  /// with primitive left[i], with an origin that spawn_origin returned for the ray's direction.
  /// Such a ray can't hit the same triangle again, so it is not tested against that triangle.
  /// kNoPrimitive stands for a ray that leaves no surface.
  void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits,
                 std::span<const PrimitiveId> left = {}) const;

  /// Sets results[i] to true if rays[i] hits anything, otherwise to false. Both spans must have the
  /// same size. Faster than single calls for any order of the rays. For `left` see intersect.
  void occluded(std::span<const Ray> rays, std::span<bool> results,
                std::span<const PrimitiveId> left = {}) const;

  /// Returns the primitive that all rays of a frustum hit first, if that is certain for the frustum
  /// as a whole. Much faster than tracing the rays, but often unknown: at silhouettes, and where
  /// triangles are small. A known result is exact.
  [[nodiscard]] CommonHit common_hit(const Frustum& frustum) const;

  [[nodiscard]] const Primitives& primitives() const;

  /// Returns a box that contains all primitives, in scene coordinates. Returns nothing if a
  /// primitive is not in the tree: planes, quadrics other than ellipsoids, and small numbers of
  /// other shapes.
  [[nodiscard]] std::optional<Box> bounds() const;

  /// Returns the size of the tree in bytes, without the scene.
  [[nodiscard]] std::size_t memory() const;

  /// Returns the tree for BvhOptions::previous. It remains valid after this object and the scene
  /// are destroyed. Memory that arrays of placed meshes borrow must not change before the tree is
  /// destroyed too.
  [[nodiscard]] std::shared_ptr<const BvhTree> tree() const;

 private:
  friend class RayTracer;  // internal queries of rays in arrays
  friend void intersect_fronts(const Bvh& bvh, std::span<const Ray> rays,
                               const BitPage* const* backs, std::span<std::optional<Hit>> hits);
  struct MICROTRACE_HIDDEN Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace microtrace
