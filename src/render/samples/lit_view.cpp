#include "render/samples/lit_view.hpp"

#include "render/samples/train_guide.hpp"

#include <microtrace/path.hpp>

#include <cstdint>
#include <functional>
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
  world_.open_backs = world_.shading->triangles_with_open_backs();
  world_.lighting = &lighting_;
}

void LitView::train(const RenderOptions& options, ImageSize size, Threads& threads) {
  const auto* integrator = dynamic_cast<const PathIntegrator*>(options.integrator);
  if (integrator == nullptr || !integrator->options().guiding) return;
  const auto go_on = [&](double) { return options.progress(0); };
  guide_ = train_guide(world_, integrator->options(), size, threads,
                       options.progress ? std::function<bool(double)>(go_on) : nullptr);
  world_.guide = guide_.get();
}

}  // namespace microtrace
