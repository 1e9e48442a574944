#include "render/aovs/aov_painter.hpp"

#include "render/tiles.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
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
    : world_(world), rays_(world.camera, world.scene), buffers_(buffers), window_(window) {
  for (const AovBuffer& buffer : buffers) aovs_.add(buffer.aov);
}

namespace {

/// Stores channels of a tile, row by row. `width` is that of the tile, most often a constant.
template <std::size_t channels, class Number>
void store(const Number* const (&values)[channels], const AovBuffer& buffer, Number* first,
           auto width, std::uint32_t height) {
  std::size_t from = 0;
  for (std::uint32_t y = 0; y < height; ++y, first += buffer.row_stride) {
    Number* to = first;
    for (std::uint32_t x = 0; x < width; ++x, ++from, to += buffer.pixel_stride) {
      for (std::size_t c = 0; c < channels; ++c)
        to[static_cast<std::ptrdiff_t>(c) * buffer.channel_stride] = values[c][from];
    }
  }
}

/// Stores a tile, in which (x, y) is the first pixel of the buffer.
template <class Number>
void store(const Sights::Values<Number>& values, const AovBuffer& buffer, std::ptrdiff_t x,
           std::ptrdiff_t y, ImageSize tile) {
  Number* const first =
      std::get<Number*>(buffer.data) + y * buffer.row_stride + x * buffer.pixel_stride;
  const auto store_channels = [&]<std::size_t channels>(const Number* const(&from)[channels]) {
    if (tile.width == kTileEdge) {
      constexpr std::integral_constant<std::uint32_t, kTileEdge> width;
      store(from, buffer, first, width, tile.height);
    } else {
      store(from, buffer, first, tile.width, tile.height);
    }
  };
  const Number *a = values[0].data(), *b = values[1].data(), *c = values[2].data();
  if (buffer.channel)
    store_channels({values[*buffer.channel].data()});
  else if (const std::size_t count = channels_of(buffer.aov).size(); count == 1)
    store_channels({a});
  else if (count == 2)
    store_channels({a, b});
  else
    store_channels({a, b, c});
}

}  // namespace

void AovPainter::paint(const PixelRect& tile) const {
  const ImageSize size = tile.size();
  std::array<Ray, kTilePixels> rays;
  for (std::uint32_t y = 0; y < size.height; ++y) {
    rays_.centers(tile.x0, tile.y0 + y,
                  std::span(rays).subspan(std::size_t{y} * size.width, size.width));
  }
  const Sights sights(world_, std::span(rays).first(std::size_t{size.width} * size.height), aovs_);
  Sights::Values<float> numbers;
  Sights::Values<std::uint32_t> ids;
  const AovBuffer* last = nullptr;  // that of the values; often the next has the same quantity
  for (const AovBuffer& buffer : buffers_) {
    const std::ptrdiff_t x = tile.x0 - window_.x0, y = tile.y0 - window_.y0;
    const bool is_known = last != nullptr && last->aov == buffer.aov;
    last = &buffer;
    if (buffer.aov == Aov::id) {
      if (!is_known) sights.ids(ids);
      store(ids, buffer, x, y, size);
    } else {
      if (!is_known) sights.values_of(buffer.aov, numbers);
      store(numbers, buffer, x, y, size);
    }
  }
}

}  // namespace microtrace
