#pragma once
/// Nearest hits of rays with a scene, by a bounding volume hierarchy.

#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace microtrace {

/// The tree without the scene.
struct BvhTree;

struct BvhOptions {
  bool fast_build = false;  ///< faster build and slower tracing, for previews
  unsigned threads = 0;     ///< for the build; 0: default_threads()
  /// Bvh::tree() of a scene with the same primitives in other positions, say the last frame of an
  /// animation. Its boxes are fitted to the new positions, which is several times faster than a
  /// build. A new tree is built if the primitives are not the same, or if fitting would make the
  /// expected cost of a ray grow by more than this factor since the tree was built; by the surface
  /// area heuristic, relative to the area of the primitives' boxes.
  std::shared_ptr<const BvhTree> previous{};
  double max_cost_growth = 1.2;
};

/// Immutable; may be used by any number of threads.
///
/// Every answer is the hit with the least (t, PrimitiveId) over the real numbers, for the float32
/// numbers of the scene and the ray. It does not depend on options, the instruction set, the order
/// of work or the function used; see docs/exactness.md.
class MICROTRACE_EXPORT Bvh {
 public:
  /// The scene must outlive this object and must not change. Throws Error (limit) if memory or
  /// primitive numbers run out.
  explicit Bvh(const Scene& scene, BvhOptions options = {});
  explicit Bvh(const Scene&& scene, BvhOptions options = {}) = delete;  // it would dangle
  ~Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  /// Nothing if the ray hits nothing or is invalid (see Ray).
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;

  /// The hit that follows `after` in the order (t, PrimitiveId) of the ray's hits. Repeated calls
  /// enumerate all hits, nearest first, including several at the same t. Each primitive counts
  /// once, with its first hit in [t_min, t_max]; a sphere is therefore returned once. Only the id
  /// of `after` is used: its exact t is computed again. Nothing follows a primitive that the ray
  /// does not hit.
  [[nodiscard]] std::optional<Hit> next(const Ray& ray, const Hit& after) const;

  /// The origin of a ray that leaves the hit of `ray` in `direction`. Like spawn_origin in
  /// spawn.hpp, but takes other surfaces into account. All guarantees there hold except the
  /// distance: the origin may be some 2^10 float32 steps away.
  ///
  /// Let w be the point of `ray` just before the hit, if the new ray returns to that side of the
  /// surface, else the point just behind it. The segment from w to the origin, excluding w, meets
  /// no triangle that has an area, no disc and no plane, and of each sphere and quadric the origin
  /// is on the same side as w. A path therefore leaves a closed mesh only where it passes through a
  /// surface on purpose, not in creases and corners. Exceptions:
  ///
  /// - If `ray` runs within a surface, w lies on it, and the origin may be on either side of it.
  /// - The segment may cross triangles without area.
  ///
  /// Nothing if there is no such float32 point, because the walls are too close together. The
  /// result does not depend on BvhOptions, and no coordinate is -0. The new ray may have t_min = 0.
  [[nodiscard]] std::optional<Vec3> spawn_origin(const Ray& ray, const Hit& hit,
                                                 const Vec3& direction) const;

  /// A ray that leaves a hit.
  struct Spawn {
    const Ray* ray;  ///< the ray of the hit
    Hit hit;         ///< a hit of this ray, as returned by intersect and next
    Vec3 direction;  ///< of the new ray
  };

  /// origins[i] equals spawn_origin for spawns[i], bit for bit, in any batch; both spans have the
  /// same size. Much faster than single calls, especially if the spawns of one hit are consecutive.
  void spawn_origins(std::span<const Spawn> spawns, std::span<std::optional<Vec3>> origins) const;

  /// True if the ray hits anything. Faster than intersect.
  [[nodiscard]] bool occluded(const Ray& ray) const;

  /// hits[i] is the nearest hit of rays[i]; both spans have the same size. Faster than single
  /// calls; fastest for runs of coherent rays with a common origin, such as those of neighboring
  /// pixels.
  void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;

  /// results[i] is true if rays[i] hits anything; both spans have the same size. Faster than single
  /// calls, for any order of the rays.
  void occluded(std::span<const Ray> rays, std::span<bool> results) const;

  [[nodiscard]] const Primitives& primitives() const;

  /// Size of the tree in bytes, without the scene.
  [[nodiscard]] std::size_t memory() const;

  /// For BvhOptions::previous. It needs neither this object nor the scene.
  [[nodiscard]] std::shared_ptr<const BvhTree> tree() const;

 private:
  struct MICROTRACE_HIDDEN Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace microtrace
