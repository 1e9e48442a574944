#pragma once
/// The implementation of PreparedScene.

#include "base/lazy.hpp"
#include "base/memory_account.hpp"
#include "render/lights/lighting.hpp"
#include "render/prepared/recentered.hpp"
#include "render/prepared/shared_tables.hpp"
#include "render/shading/shading.hpp"
#include "render/surfaces.hpp"
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

/// Makes each part on first use. Any number of threads may use it.
class PreparedScene::Content {
 public:
  /// Counts memory in `account`, which already includes the scene if its memory is counted.
  Content(std::shared_ptr<const Scene> scene, BvhOptions options,
          std::shared_ptr<SharedTables> tables, MemoryAccount account);

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Bvh& bvh() const;
  [[nodiscard]] const SurfaceFinder& surface_finder() const;
  [[nodiscard]] const Surfaces& surfaces() const;
  [[nodiscard]] const Shading& shading() const;
  [[nodiscard]] const Emitters& emitters() const;
  /// The lights of the scene, with `in_place` instead of its environment if there is one. A scene
  /// with neither lights nor an environment gets the studio.
  [[nodiscard]] Lighting lighting(const std::optional<Environment>& in_place) const;
  [[nodiscard]] const std::shared_ptr<SharedTables>& tables() const { return tables_; }

  /// The scene and the camera, translated to near the origin for Monte Carlo integrators. Nothing
  /// if they are near it already, or if the translation would round a coordinate.
  struct Recentered {
    std::shared_ptr<const Content> content;
    Camera camera;
  };
  [[nodiscard]] std::optional<Recentered> recentered(const Camera& camera) const;

  /// The scene with its points and line segments widened to one pixel of a camera.
  [[nodiscard]] std::shared_ptr<const Content> widened(const Camera& camera, ImageSize size) const;

 private:
  /// Makes a T from these arguments; its memory counts on this scene's account.
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
  Lazy<Shading> shading_;
  Lazy<Emitters> emitters_;
  Lazy<std::optional<PointBounds>> bounds_;  // nothing: some shapes can't be translated
  // The last translation requested: the cameras of one scene mostly have the same one.
  mutable std::mutex moved_mutex_;
  mutable DVec3 moved_by_{0};
  mutable std::shared_ptr<const Content> moved_;
};

/// A pointer to a scene that the caller keeps alive and unchanged.
[[nodiscard]] inline std::shared_ptr<const Scene> borrowed(const Scene& scene) {
  return {std::shared_ptr<void>(), &scene};
}

}  // namespace microtrace
