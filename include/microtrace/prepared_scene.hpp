#pragma once
/// A scene prepared for ray queries and rendering.

#include <microtrace/bvh.hpp>
#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/surface_buffers.hpp>
#include <microtrace/surface_interaction.hpp>

#include <memory>
#include <optional>
#include <span>

namespace microtrace {

class SharedTables;

struct PrepareOptions {
  bool fast_build = false;  ///< builds the tree faster, but makes rays slower
  unsigned threads = 0;     ///< number of threads for the build; 0: default_threads()
  /// If given, counts the memory of the tree, mip maps and light tables. Must outlive all copies of
  /// this scene and of the scenes that share its tables.
  MemoryBudget* memory = nullptr;
  /// tables() of another scene, such as the previous frame of an animation. Mip maps and
  /// environment tables are shared if both scenes hold the same Image and RadianceMap objects. The
  /// tree is refitted to the new scene as described for BvhOptions::previous. If this is the last
  /// reference to the tables, parts that are not reused are released early.
  std::shared_ptr<const SharedTables> tables{};
  /// See BvhOptions::max_cost_growth. Choose a lower value if many rays will be traced per
  /// primitive, because a new tree then pays off sooner.
  double max_cost_growth = 1.2;
};

/// A scene with its tree. Immutable and cheap to copy; copies share everything. Any number of
/// threads may use it at the same time. The constructor builds the tree; mip maps, light tables,
/// and the trees of scenes with points or line segments are made by the first picture that needs
/// them.
///
/// Rays, points and normals are in world space. If Scene::origin is not zero, ray origins are
/// translated in float64 and rounded to float32 once. To avoid this rounding, use bvh() with rays
/// in scene coordinates.
class MICROTRACE_EXPORT PreparedScene {
 public:
  /// Builds the tree. Throws Error: invalid_scene if an index in the scene is out of range, or if a
  /// mesh has a different number of vertex attributes than of positions; limit if memory runs out
  /// or the scene has too many primitives.
  explicit PreparedScene(Scene scene, PrepareOptions options = {});
  /// Shares the scene instead of moving it. The scene must not change any more. Throws Error like
  /// the other constructor.
  explicit PreparedScene(std::shared_ptr<const Scene> scene, PrepareOptions options = {});

  [[nodiscard]] const Scene& scene() const;
  /// The tree; its rays and hits are in scene coordinates.
  [[nodiscard]] const Bvh& bvh() const;

  /// Like the functions of Bvh with the same names, but for rays in world space.
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;
  [[nodiscard]] std::optional<Hit> next(const Ray& ray, const Hit& after) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;
  void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;
  void occluded(std::span<const Ray> rays, std::span<bool> results) const;

  /// Returns position, normals, texture coordinates, object and triangle at a hit of `ray`. The
  /// result refers to the scene, so this object or a copy of it must outlive the result.
  [[nodiscard]] SurfaceInteraction surface(const Ray& ray, const Hit& hit) const;
  /// Stores the surface properties at hits[i] of rays[i] for all i. Both spans must have the same
  /// size. Faster than single calls.
  void surfaces(std::span<const Ray> rays, std::span<const std::optional<Hit>> hits,
                const SurfaceBuffers& buffers) const;
  /// Like surfaces(), but for rays in scene coordinates, see in_scene(). The resulting positions
  /// are in world space.
  void surfaces_in_scene(std::span<const Ray> rays, std::span<const std::optional<Hit>> hits,
                         const SurfaceBuffers& buffers) const;

  /// Returns the mip maps, environment tables and tree, for PrepareOptions::tables. They remain
  /// valid after the scene is destroyed.
  [[nodiscard]] std::shared_ptr<const SharedTables> tables() const;

  /// Converts a ray from world space to scene coordinates (see Scene::origin).
  [[nodiscard]] Ray in_scene(const Ray& ray) const;

  /// For internal use.
  class MICROTRACE_HIDDEN Content;
  explicit PreparedScene(std::shared_ptr<const Content> content);
  [[nodiscard]] const Content& content() const { return *content_; }

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace microtrace
