#include "render/aovs/aov_painter.hpp"

#include "render/aovs/aov_value.hpp"
#include "render/tiles.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace microtrace {

std::vector<AovBuffer> add_channels(std::span<const Aov> aovs, Film& film) {
  const std::size_t pixels = std::size_t{film.size().width} * film.size().height;
  std::vector<AovBuffer> buffers;
  for (const Aov aov : aovs) {
    const auto channels = channels_of(aov);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      Channel added{.name = std::string(name_of(aov)).append(".").append(channels[c]),
                    .values = {}};
      AovBuffer buffer{.aov = aov, .row_stride = std::ptrdiff_t{film.size().width}, .channel = c};
      if (aov == Aov::id)
        buffer.data = added.values.emplace<std::vector<std::uint32_t>>(pixels).data();
      else
        buffer.data = added.values.emplace<std::vector<float>>(pixels).data();
      film.channels.push_back(std::move(added));
      buffers.push_back(buffer);
    }
  }
  return buffers;
}

AovPainter::AovPainter(const World& world, std::span<const AovBuffer> buffers,
                       const PixelRect& window)
    : world_(world), rays_(world.camera, world.scene), buffers_(buffers), window_(window) {}

void AovPainter::set(std::ptrdiff_t x, std::ptrdiff_t y, const Ray& ray,
                     const std::optional<Hit>& hit) const {
  std::optional<Sight> sight;
  if (hit && std::ranges::any_of(buffers_, [](const auto& b) { return b.aov != Aov::id; })) {
    sight.emplace(Sight{.world = world_,
                        .ray = ray,
                        .hit = *hit,
                        .at = interact(world_.bvh.primitives(), ray, *hit)});
  }
  for (const AovBuffer& buffer : buffers_) {
    const auto store = [&](const auto& values) {
      using Number = typename std::remove_cvref_t<decltype(values)>::value_type;
      Number* to = std::get<Number*>(buffer.data) + y * buffer.row_stride + x * buffer.pixel_stride;
      if (buffer.channel) {
        *to = values[*buffer.channel];
        return;
      }
      for (std::size_t c = 0; c < channels_of(buffer.aov).size(); ++c)
        to[static_cast<std::ptrdiff_t>(c) * buffer.channel_stride] = values[c];
    };
    if (buffer.aov == Aov::id)
      store(ids_of(world_, hit));
    else
      store(sight ? value_of(buffer.aov, *sight) : value_of_nothing(buffer.aov));
  }
}

void AovPainter::paint(const PixelRect& tile) const {
  std::array<Ray, kMaxBatch> rays;
  std::array<std::optional<Hit>, kMaxBatch> hits;
  std::size_t count = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x) rays[count++] = rays_(x + 0.5, y + 0.5);
  }
  find_seen(world_, std::span(rays).first(count), std::span(hits).first(count));
  count = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x, ++count)
      set(std::ptrdiff_t{x - window_.x0}, std::ptrdiff_t{y - window_.y0}, rays[count], hits[count]);
  }
}

}  // namespace microtrace
