#include "render/samples/lit_view.hpp"

#include <cstdint>
#include <utility>

namespace microtrace {
namespace {

/// Texture filters of Monte Carlo integrators assume this many samples per pixel, because the
/// actual number is not known in advance.
constexpr std::uint32_t kSamplesOfRandomTextures = 16;

}  // namespace

SceneView near_origin(const std::shared_ptr<const PreparedScene::Content>& shown,
                      const Camera& camera, ImageSize size) {
  const auto moved = shown->recentered(camera);
  return moved ? SceneView(moved->content, moved->camera, size) : SceneView(shown, camera, size);
}

LitView::LitView(SceneView view, const RenderOptions& options)
    : view_(std::move(view)),
      lighting_(view_.content->lighting(options.environment)),
      world_(view_.world(kSamplesOfRandomTextures)) {
  world_.seed = options.seed;
  world_.shading = &view_.content->shading();
  world_.lighting = &lighting_;
}

}  // namespace microtrace
