#pragma once
/// A scene with all that rays and pictures need, prepared once for any number of them.

#include <microtrace/bvh.hpp>
#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>
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
  /// tables() of another scene, say the last frame of an animation: mip maps and environment tables
  /// are shared where both scenes hold the same Image and RadianceMap objects.
  std::shared_ptr<const SharedTables> tables{};
};

/// Immutable, and cheap to copy: copies share everything. Any number of threads may use it at a
/// time. Tree and scene are ready when the constructor returns; mip maps and light tables are made
/// by the first picture that needs them.
///
/// Rays, points and normals are in world space. Where Scene::origin is not zero, the origin of a
/// ray is moved by it in float64 and rounded to float32 once; use bvh() with rays in the scene's
/// own coordinates to leave that out.
class MICROTRACE_EXPORT PreparedScene {
 public:
  /// Throws Error: invalid_scene where an index of the scene is out of range, or the number of a
  /// mesh's attributes is not that of its positions; limit where memory or primitive numbers run
  /// out.
  explicit PreparedScene(Scene scene, const PrepareOptions& options = {});
  /// The same for a scene that must not change any more.
  explicit PreparedScene(std::shared_ptr<const Scene> scene, const PrepareOptions& options = {});

  [[nodiscard]] const Scene& scene() const;
  /// The tree, which works in the scene's own coordinates.
  [[nodiscard]] const Bvh& bvh() const;

  /// As the functions of Bvh.
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;
  [[nodiscard]] std::optional<Hit> next(const Ray& ray, const Hit& after) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;
  void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;
  void occluded(std::span<const Ray> rays, std::span<bool> results) const;

  /// Position, normals, texture coordinates, object and triangle at a hit of `ray`. It points into
  /// the scene, which this or a copy must keep alive.
  [[nodiscard]] SurfaceInteraction surface(const Ray& ray, const Hit& hit) const;

  /// Mip maps and environment tables, for PrepareOptions.
  [[nodiscard]] std::shared_ptr<const SharedTables> tables() const;

  /// A ray of world space in the scene's own coordinates.
  [[nodiscard]] Ray in_scene(const Ray& ray) const;

  /// For the library.
  class MICROTRACE_HIDDEN Content;
  explicit PreparedScene(std::shared_ptr<const Content> content);
  [[nodiscard]] const Content& content() const { return *content_; }

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace microtrace
