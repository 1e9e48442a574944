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
  bool fast_build = false;  ///< builds the tree faster; rays take longer
  unsigned threads = 0;     ///< for the build; 0: default_threads()
  /// If given, counts the memory of tree, mip maps and light tables; must outlive all copies of the
  /// scene, and of those that share its tables.
  MemoryBudget* memory = nullptr;
  /// tables() of another scene, such as the previous frame of an animation: mip maps and
  /// environment tables are shared if both scenes hold the same Image and RadianceMap objects, and
  /// the tree is fitted to the new scene as BvhOptions says. If this is the last handle, memory
  /// that is not kept is released early.
  std::shared_ptr<const SharedTables> tables{};
  /// BvhOptions::max_cost_growth. The more rays there will be for each primitive, the better a new
  /// tree pays.
  double max_cost_growth = 1.2;
};

/// Immutable and cheap to copy; copies share everything. Any number of threads may use it at the
/// same time. The constructor builds the tree; mip maps and light tables are made by the first
/// picture that needs them.
///
/// Rays, points and normals are in world space. If Scene::origin is not zero, ray origins are
/// translated in float64 and rounded to float32 once. To avoid this rounding, use bvh() with rays
/// in scene coordinates.
class MICROTRACE_EXPORT PreparedScene {
 public:
  /// Throws Error: invalid_scene if an index of the scene is out of range, or if the number of a
  /// mesh's attributes differs from that of its positions; limit if memory or primitive numbers run
  /// out.
  explicit PreparedScene(Scene scene, PrepareOptions options = {});
  /// The same for a shared scene, which must no longer change.
  explicit PreparedScene(std::shared_ptr<const Scene> scene, PrepareOptions options = {});

  [[nodiscard]] const Scene& scene() const;
  /// The tree, in scene coordinates.
  [[nodiscard]] const Bvh& bvh() const;

  /// See the functions of Bvh.
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;
  [[nodiscard]] std::optional<Hit> next(const Ray& ray, const Hit& after) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;
  void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;
  void occluded(std::span<const Ray> rays, std::span<bool> results) const;

  /// Position, normals, texture coordinates, object and triangle at a hit of `ray`. Refers to the
  /// scene, which this object or a copy must keep alive.
  [[nodiscard]] SurfaceInteraction surface(const Ray& ray, const Hit& hit) const;
  /// The same for many rays and their hits, faster. Both spans have the same size.
  void surfaces(std::span<const Ray> rays, std::span<const std::optional<Hit>> hits,
                const SurfaceBuffers& buffers) const;
  /// The same for rays in scene coordinates, see in_scene(). Positions are in world space.
  void surfaces_in_scene(std::span<const Ray> rays, std::span<const std::optional<Hit>> hits,
                         const SurfaceBuffers& buffers) const;

  /// Mip maps, environment tables and the tree, for PrepareOptions::tables. They don't refer to the
  /// scene.
  [[nodiscard]] std::shared_ptr<const SharedTables> tables() const;

  /// Converts a ray from world space to scene coordinates.
  [[nodiscard]] Ray in_scene(const Ray& ray) const;

  /// Internal.
  class MICROTRACE_HIDDEN Content;
  explicit PreparedScene(std::shared_ptr<const Content> content);
  [[nodiscard]] const Content& content() const { return *content_; }

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace microtrace
