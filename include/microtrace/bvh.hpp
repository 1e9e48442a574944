#pragma once
/// The nearest hit of a ray with a scene, by a bounding volume hierarchy.

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

struct BvhOptions {
  bool fast_build = false;  ///< a tree that is made sooner and traced slower, for previews
  unsigned threads = 0;     ///< for the build; 0: default_threads()
};

/// Immutable; any number of threads may use one at a time.
///
/// Every answer is the hit that is least by (t, PrimitiveId) over the real numbers, for the float32
/// numbers that scene and ray hold. Options, instruction set, the order of the work and the way of
/// asking can't change it; docs/exactness.md says why.
class MICROTRACE_EXPORT Bvh {
 public:
  /// The scene must outlive this and stay as it is. Throws Error (limit) where memory or primitive
  /// numbers run out.
  explicit Bvh(const Scene& scene, const BvhOptions& options = {});
  explicit Bvh(const Scene&& scene, const BvhOptions& options = {}) = delete;  // it would dangle
  ~Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  /// Nothing if the ray hits nothing or is not valid (see Ray).
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;

  /// The hit that follows `after` in the order (t, PrimitiveId) of the ray's hits: by repeating it
  /// all are found, nearest first, none lost where several lie at one t. Each primitive counts with
  /// its one first hit in [t_min, t_max]; so a sphere comes once.
  /// Of `after` only the number is used: t is found anew, exactly. Nothing follows a primitive that
  /// the ray does not hit.
  [[nodiscard]] std::optional<Hit> next(const Ray& ray, const Hit& after) const;

  /// The origin of a ray that leaves the hit of `ray` into `direction`: as spawn_origin of
  /// spawn.hpp has it, with the other surfaces taken into account. All that is promised there holds
  /// but nearness: the origin may be some 2^10 representable numbers away.
  ///
  /// Let w be the point of `ray` just before the hit, if the new ray goes back to that side of the
  /// surface, else the point just behind it. The straight way from w to the origin, w itself left
  /// out, meets no triangle that has an area, no disc and no plane, and of each sphere and quadric
  /// the origin is on the side where w is. So a path leaves a closed mesh only where it passes
  /// through a surface on purpose, not in creases and corners. Exceptions:
  ///
  /// - If `ray` runs within a surface, w is a point of it, and there is no side to keep: the origin
  ///   may be on either side of that surface.
  /// - Triangles without area bound nothing: the way may cross them.
  ///
  /// Nothing if there is no such float32 point: between walls closer together than that. The answer
  /// does not depend on BvhOptions, and no coordinate is -0.
  [[nodiscard]] std::optional<Vec3> spawn_origin(const Ray& ray, const Hit& hit,
                                                 const Vec3& direction) const;

  /// A ray that leaves a hit.
  struct Spawn {
    const Ray* ray;  ///< that hit
    Hit hit;         ///< one of its hits, as intersect and next give them
    Vec3 direction;  ///< of the new ray
  };

  /// origins[i] is spawn_origin's answer to spawns[i] bit for bit, whatever is asked together; both
  /// have one length. Much faster than asking one by one, most so where those of one hit follow
  /// each other.
  void spawn_origins(std::span<const Spawn> spawns, std::span<std::optional<Vec3>> origins) const;

  /// Whether intersect(ray) would find something; sooner.
  [[nodiscard]] bool occluded(const Ray& ray) const;

  /// hits[i] answers rays[i]; both have one length. Sooner than asking ray by ray; fastest where
  /// runs of rays start at one point and go nearly the same way, as those of neighbouring pixels
  /// do.
  void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;

  /// results[i] says whether rays[i] hits something; both have one length. Sooner than asking ray
  /// by ray, in any order of the rays.
  void occluded(std::span<const Ray> rays, std::span<bool> results) const;

  [[nodiscard]] const Primitives& primitives() const;

  /// Bytes that the tree takes, beside the scene.
  [[nodiscard]] std::size_t memory() const;

 private:
  struct MICROTRACE_HIDDEN Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace microtrace
