#include "io/sidecar/seen_pixels.hpp"

#include <algorithm>

namespace microtrace::io {

std::optional<std::vector<SeenPixels>> find_seen_pixels(const Film& film, std::size_t objects) {
  const auto channel = std::ranges::find(film.channels, "id.instance", &Channel::name);
  if (channel == film.channels.end()) return std::nullopt;
  const auto* ids = std::get_if<std::vector<std::uint32_t>>(&channel->values);
  if (ids == nullptr) return std::nullopt;
  std::vector<SeenPixels> seen(objects);
  std::size_t pixel = 0;
  for (std::uint32_t y = film.y0; y < film.y0 + film.size().height; ++y) {
    for (std::uint32_t x = film.x0; x < film.x0 + film.size().width; ++x) {
      const std::uint32_t id = (*ids)[pixel++];
      if (id == 0 || id > objects) continue;
      SeenPixels& object = seen[id - 1];
      const PixelRect here{.x0 = x, .y0 = y, .x1 = x + 1, .y1 = y + 1};
      if (object.count++ == 0) object.box = here;
      object.box = {.x0 = std::min(object.box.x0, here.x0),
                    .y0 = std::min(object.box.y0, here.y0),
                    .x1 = std::max(object.box.x1, here.x1),
                    .y1 = std::max(object.box.y1, here.y1)};
    }
  }
  return seen;
}

}  // namespace microtrace::io
