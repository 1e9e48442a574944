#pragma once
/// The content of a picture: a scene, a camera, and the part of the picture to render.

#include "render/prepared/content.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

namespace microtrace {

/// The part of the picture to render. Throws Error (usage) if the crop is empty or not inside the
/// picture.
[[nodiscard]] PixelRect window_of(ImageSize size, const std::optional<PixelRect>& crop);

/// The scene with points and lines widened for this camera.
[[nodiscard]] std::shared_ptr<const PreparedScene::Content> content_for(
    const std::shared_ptr<const PreparedScene::Content>& content, const Camera& camera,
    ImageSize size);

/// The scene that is rendered: the prepared scene, or a variant with widened points and lines or a
/// translated origin.
struct SceneView {
  std::shared_ptr<const PreparedScene::Content> content;
  RayGenerator camera;

  SceneView(std::shared_ptr<const PreparedScene::Content> c, const Camera& from, ImageSize size)
      : content(std::move(c)), camera(from, size) {}

  /// The scene for integrators that compute no light.
  [[nodiscard]] World unlit_world(std::uint32_t samples) const {
    World result = world(samples);
    result.open_backs = content->one_sided_triangles().pages();
    return result;
  }
  [[nodiscard]] World world(std::uint32_t samples) const {
    return {.scene = content->scene(),
            .bvh = content->bvh(),
            .camera = camera,
            .samples = samples,
            .surfaces = content->surfaces()};
  }
};

}  // namespace microtrace
