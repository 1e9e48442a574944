#include "render/aovs/aov_painter.hpp"

#include "render/film/tiles.hpp"
#include "scene/occupied_part.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
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

namespace {

PixelRect part_with_hits(const World& world, const Camera& camera, const PixelRect& window) {
  const std::optional<Box> box = world.bvh.bounds();
  return box ? occupied_part(camera, world.camera, box->lo, box->hi, window) : window;
}

}  // namespace

AovPainter::AovPainter(const World& world, const Camera& camera, std::span<const AovBuffer> buffers,
                       const PixelRect& window)
    : world_(world),
      rays_(world.camera, world.scene),
      buffers_(buffers),
      window_(window),
      occupied_(part_with_hits(world, camera, window)) {
  for (const AovBuffer& buffer : buffers) aovs_.add(buffer.aov);
}

namespace {

/// Stores channels of a tile, row by row. `width` is the tile's width. In the most common cases,
/// the width and the strides are compile-time constants.
template <std::size_t channels, class Number>
void store(const Number* const (&values)[channels], Number* first, std::ptrdiff_t row_stride,
           auto pixel_stride, auto channel_stride, auto width, std::uint32_t height) {
  std::size_t from = 0;
  for (std::uint32_t y = 0; y < height; ++y, first += row_stride) {
    Number* to = first;
    for (std::uint32_t x = 0; x < width; ++x, ++from, to += pixel_stride) {
      for (std::size_t c = 0; c < channels; ++c)
        to[static_cast<std::ptrdiff_t>(c) * channel_stride] = values[c][from];
    }
  }
}

/// The location of the first value of a tile whose first pixel is the pixel (x, y) of the buffer.
template <class Number>
Number* first_of(const AovBuffer& buffer, std::ptrdiff_t x, std::ptrdiff_t y) {
  return std::get<Number*>(buffer.data) + y * buffer.row_stride + x * buffer.pixel_stride;
}

template <class Number, std::size_t channels>
void store_channels(const Number* const (&values)[channels], const AovBuffer& buffer, Number* first,
                    ImageSize tile) {
  using Channels = std::integral_constant<std::ptrdiff_t, std::ptrdiff_t{channels}>;
  const bool is_packed =
      buffer.pixel_stride == Channels() && (channels == 1 || buffer.channel_stride == 1);
  if (is_packed && tile.width == kTileEdge) {
    store(values, first, buffer.row_stride, Channels(), std::integral_constant<std::ptrdiff_t, 1>(),
          std::integral_constant<std::uint32_t, kTileEdge>(), tile.height);
  } else {
    store(values, first, buffer.row_stride, buffer.pixel_stride, buffer.channel_stride, tile.width,
          tile.height);
  }
}

std::size_t channel_count(const AovBuffer& buffer) {
  return buffer.channel ? 1 : channels_of(buffer.aov).size();
}

template <class Number>
void store(const Sights::Values<Number>& values, const AovBuffer& buffer, Number* first,
           ImageSize tile) {
  const Number *a = values[0].data(), *b = values[1].data(), *c = values[2].data();
  if (buffer.channel)
    store_channels({values[*buffer.channel].data()}, buffer, first, tile);
  else if (const std::size_t count = channel_count(buffer); count == 1)
    store_channels({a}, buffer, first, tile);
  else if (count == 2)
    store_channels({a, b}, buffer, first, tile);
  else
    store_channels({a, b, c}, buffer, first, tile);
}

/// Sets all values of a tile to `value`.
template <class Number>
void fill(Number value, const AovBuffer& buffer, Number* first, ImageSize tile) {
  const std::size_t channels = channel_count(buffer);
  const bool is_packed = buffer.pixel_stride == static_cast<std::ptrdiff_t>(channels) &&
                         (channels == 1 || buffer.channel_stride == 1);
  for (std::uint32_t y = 0; y < tile.height; ++y, first += buffer.row_stride) {
    if (is_packed) {
      std::fill_n(first, channels * tile.width, value);
      continue;
    }
    for (std::uint32_t x = 0; x < tile.width; ++x) {
      for (std::size_t c = 0; c < channels; ++c)
        first[x * buffer.pixel_stride + static_cast<std::ptrdiff_t>(c) * buffer.channel_stride] =
            value;
    }
  }
}

}  // namespace

void AovPainter::paint_empty(const PixelRect& tile) const {
  const std::ptrdiff_t x = tile.x0 - window_.x0, y = tile.y0 - window_.y0;
  for (const AovBuffer& buffer : buffers_) {
    if (buffer.aov == Aov::id)
      fill(0U, buffer, first_of<std::uint32_t>(buffer, x, y), tile.size());
    else
      fill(value_of_nothing(buffer.aov), buffer, first_of<float>(buffer, x, y), tile.size());
  }
}

void AovPainter::paint(const PixelRect& tile) const {
  if (!overlap(tile, occupied_)) {
    paint_empty(tile);
    return;
  }
  const ImageSize size = tile.size();
  const std::size_t pixels = std::size_t{size.width} * size.height;
  std::array<Ray, kTilePixels> rays;
  rays_.centers(tile, std::span(rays).first(pixels));
  const Sights sights(world_, std::span(rays).first(pixels), aovs_);
  if (sights.is_empty()) {
    paint_empty(tile);
    return;
  }
  Sights::Values<float> numbers;
  Sights::Values<std::uint32_t> ids;
  const std::ptrdiff_t x = tile.x0 - window_.x0, y = tile.y0 - window_.y0;
  const AovBuffer* last = nullptr;  // the previous buffer, which often has the same quantity
  for (const AovBuffer& buffer : buffers_) {
    if (buffer.aov == Aov::id) {
      for (std::size_t c = 0; c < ids.size(); ++c) {
        if (buffer.channel.value_or(c) == c) sights.ids(c, ids[c]);
      }
      store(ids, buffer, first_of<std::uint32_t>(buffer, x, y), size);
      continue;
    }
    if (last == nullptr || last->aov != buffer.aov) sights.values_of(buffer.aov, numbers);
    last = &buffer;
    store(numbers, buffer, first_of<float>(buffer, x, y), size);
  }
}

}  // namespace microtrace
