#include "render/aovs/aov_painter.hpp"

#include "render/aovs/aov_value.hpp"
#include "render/tiles.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace microtrace {

AovPainter::AovPainter(const World& world, std::span<const Aov> aovs, const PixelRect& window,
                       Film& film)
    : world_(world), rays_(world.camera, world.scene), aovs_(aovs), window_(window), film_(film) {
  const std::size_t pixels = std::size_t{film.size().width} * film.size().height;
  for (const Aov aov : aovs) {
    for (const std::string_view channel : channels_of(aov)) {
      Channel added{.name = std::string(name_of(aov)).append(".").append(channel), .values = {}};
      if (aov == Aov::id) {
        added.values = std::vector<std::uint32_t>(pixels);
      } else {
        added.values = std::vector<float>(pixels);
      }
      film.channels.push_back(std::move(added));
    }
  }
}

void AovPainter::set(std::size_t pixel, const Ray& ray, const std::optional<Hit>& hit) const {
  std::optional<Sight> sight;
  if (hit && std::ranges::any_of(aovs_, [](Aov aov) { return aov != Aov::id; })) {
    sight.emplace(Sight{.world = world_,
                        .ray = ray,
                        .hit = *hit,
                        .at = interact(world_.bvh.primitives(), ray, *hit)});
  }
  std::size_t channel = 0;
  const auto store = [&](const auto& values, std::size_t count) {
    using Number = typename std::remove_cvref_t<decltype(values)>::value_type;
    for (std::size_t i = 0; i < count; ++i) {
      std::get<std::vector<Number>>(film_.channels[channel++].values)[pixel] = values[i];
    }
  };
  for (const Aov aov : aovs_) {
    const std::size_t count = channels_of(aov).size();
    if (aov == Aov::id) {
      store(ids_of(world_, hit), count);
    } else {
      store(sight ? value_of(aov, *sight) : value_of_nothing(aov), count);
    }
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
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x, ++count) {
      set(std::size_t{y - window_.y0} * film_.size().width + (x - window_.x0), rays[count],
          hits[count]);
    }
  }
}

}  // namespace microtrace
