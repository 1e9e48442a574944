#include "render/prepared/view.hpp"

#include <microtrace/error.hpp>
#include <microtrace/segments.hpp>

#include <string>

namespace microtrace {

PixelRect window_of(ImageSize size, const std::optional<PixelRect>& crop) {
  if (!crop) return {.x0 = 0, .y0 = 0, .x1 = size.width, .y1 = size.height};
  if (crop->x0 < crop->x1 && crop->y0 < crop->y1 && crop->x1 <= size.width &&
      crop->y1 <= size.height)
    return *crop;
  throw Error(ErrorKind::usage, "",
              "the crop must be a nonempty part of the picture: 0 <= x0 < x1 <= " +
                  std::to_string(size.width) + ", 0 <= y0 < y1 <= " + std::to_string(size.height));
}

std::shared_ptr<const PreparedScene::Content> content_for(
    const std::shared_ptr<const PreparedScene::Content>& content, const Camera& camera,
    ImageSize size) {
  return has_segments(content->scene()) ? content->widened(camera, size) : content;
}

}  // namespace microtrace
