#pragma once
/// The scene of Monte Carlo integrators.

#include "render/film/tiles.hpp"
#include "render/guiding/path_guide.hpp"
#include "render/lighting/lighting.hpp"
#include "render/prepared/view.hpp"

#include <microtrace/render.hpp>

#include <memory>

namespace microtrace {

/// Returns the scene and the camera, translated close to the origin if possible. `shown` is the
/// result of content_for().
[[nodiscard]] SceneView near_origin(const std::shared_ptr<const PreparedScene::Content>& shown,
                                    const Camera& camera, ImageSize size);

/// A scene with its light, as one camera sees it.
class LitView {
 public:
  LitView(SceneView view, const RenderOptions& options);
  LitView(const LitView&) = delete;
  LitView& operator=(const LitView&) = delete;

  [[nodiscard]] const World& world() const { return world_; }

  /// Trains the guide of `options`, if they use one, for pictures of this size.
  void train(const RenderOptions& options, ImageSize size, Threads& threads);

 private:
  SceneView view_;
  Lighting lighting_;
  World world_;
  std::unique_ptr<const PathGuide> guide_;
};

}  // namespace microtrace
