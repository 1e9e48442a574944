#pragma once
/// The data of a PreparedScene.

#include "base/lazy.hpp"
#include "base/memory_account.hpp"
#include "render/lighting/lighting.hpp"
#include "render/lighting/sky_visibility.hpp"
#include "render/prepared/one_sided_triangles.hpp"
#include "render/prepared/recentered.hpp"
#include "render/prepared/shared_tables.hpp"
#include "render/shading/shading.hpp"
#include "render/shading/surfaces.hpp"
#include "scene/surface/surface_finder.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/segments.hpp>

#include <memory>
#include <mutex>
#include <optional>

namespace microtrace {

/// Each part is made on first use. Any number of threads may use this object.
class PreparedScene::Content {
 public:
  /// Charges memory to `account`. If the memory of the scene is to be counted, `account` already
  /// includes it.
  Content(std::shared_ptr<const Scene> scene, BvhOptions options,
          std::shared_ptr<SharedTables> tables, MemoryAccount account);

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Bvh& bvh() const;
  [[nodiscard]] const SurfaceFinder& surface_finder() const;
  [[nodiscard]] const Surfaces& surfaces() const;
  [[nodiscard]] const OneSidedTriangles& one_sided_triangles() const;
  [[nodiscard]] const Shading& shading() const;
  [[nodiscard]] const Emitters& emitters() const;
  /// The scene's lighting. `in_place`, if present, replaces the scene's environment. A scene with
  /// neither lights nor an environment is lit by the studio.
  [[nodiscard]] Lighting lighting(const std::optional<Environment>& in_place) const;
  [[nodiscard]] const std::shared_ptr<SharedTables>& tables() const { return tables_; }

  /// The scene and the camera, translated close to the origin for Monte Carlo integrators. Nothing
  /// if they are already close to it, or if the translation would round a coordinate.
  struct Recentered {
    std::shared_ptr<const Content> content;
    Camera camera;
  };
  [[nodiscard]] std::optional<Recentered> recentered(const Camera& camera) const;

  /// The scene with its points and line segments widened to one pixel of this camera.
  [[nodiscard]] std::shared_ptr<const Content> widened(const Camera& camera, ImageSize size) const;

 private:
  /// Where the scene is open to its environment; null unless it is enclosed.
  [[nodiscard]] const SkyVisibility* sky_visibility() const;

  /// Makes a T from these arguments and charges its memory to this scene's account.
  template <class T, class... Arguments>
  [[nodiscard]] std::unique_ptr<T> make(Arguments&&... arguments) const;

  std::shared_ptr<const Scene> scene_;
  mutable std::shared_ptr<const BvhTree> previous_;  // released when bvh_ is made
  BvhOptions options_;
  std::shared_ptr<SharedTables> tables_;
  mutable std::mutex memory_mutex_;
  mutable MemoryAccount memory_;
  Lazy<Bvh> bvh_;
  Lazy<SurfaceFinder> surface_finder_;
  Lazy<Surfaces> surfaces_;
  Lazy<OneSidedTriangles> one_sided_triangles_;
  Lazy<Shading> shading_;
  Lazy<Emitters> emitters_;
  Lazy<SkyVisibility> sky_visibility_;
  Lazy<std::optional<PointBounds>> bounds_;  // nothing if some shapes can't be translated
  // The most recent translation. Different cameras of a scene usually need the same one.
  mutable std::mutex moved_mutex_;
  mutable DVec3 moved_by_{0};
  mutable std::shared_ptr<const Content> moved_;
};

/// A pointer to a scene that the caller keeps alive and unchanged.
[[nodiscard]] inline std::shared_ptr<const Scene> borrowed(const Scene& scene) {
  return {std::shared_ptr<void>(), &scene};
}

}  // namespace microtrace
