#include "render/texture_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace microtrace {
namespace {

/// The two pixels between which a coordinate lies, and how far it is from the first to the second.
struct Between {
  std::uint32_t first, second;
  float share;
};

std::int32_t mirrored(std::int32_t i, std::int32_t size) {
  return i < 0 ? -1 - i : i >= size ? 2 * size - 1 - i : i;
}

/// u as the texture's coordinate, `size` pixels.
Between between(float u, Wrap wrap, std::uint32_t pixels, Filter filter) {
  const auto size = static_cast<std::int32_t>(pixels);
  if (!(std::abs(u) < 0x1p22F)) u = 0;  // beyond, float32 has no room for a fraction
  float position = 0;
  switch (wrap) {
    case Wrap::repeat:
      position = u - std::floor(u);
      break;
    case Wrap::mirrored_repeat: {
      const float turn = u - 2 * std::floor(u * 0.5F);
      position = turn > 1 ? 2 - turn : turn;
      break;
    }
    case Wrap::clamp_to_edge:
      position = std::clamp(u, 0.0F, 1.0F);
      break;
  }
  position *= static_cast<float>(size);
  if (filter == Filter::nearest) {
    const auto pixel =
        static_cast<std::uint32_t>(std::min(static_cast<std::int32_t>(position), size - 1));
    return {.first = pixel, .second = pixel, .share = 0};
  }
  const float left = std::floor(position - 0.5F);
  auto first = static_cast<std::int32_t>(left), second = first + 1;
  if (wrap == Wrap::repeat) {
    if (first < 0) first += size;
    if (second >= size) second -= size;
  } else {
    // At both ends of a mirrored image its own pixels come again.
    first = std::clamp(mirrored(first, size), 0, size - 1);
    second = std::clamp(mirrored(second, size), 0, size - 1);
  }
  return {.first = static_cast<std::uint32_t>(std::clamp(first, 0, size - 1)),
          .second = static_cast<std::uint32_t>(std::clamp(second, 0, size - 1)),
          .share = position - 0.5F - left};
}

template <typename Number>
Vec4 decoded(const Number* s, std::uint32_t channels, std::span<const float> color,
             std::span<const float> alpha) {
  switch (channels) {
    case 1:
      return {Vec3(color[s[0]]), 1};
    case 2:
      return {Vec3(color[s[0]]), alpha[s[1]]};
    case 3:
      return {color[s[0]], color[s[1]], color[s[2]], 1};
    default:
      return {color[s[0]], color[s[1]], color[s[2]], alpha[s[3]]};
  }
}

}  // namespace

Vec4 TextureMap::texel(std::size_t level, std::size_t index) const {
  if (level > 0) {
    const std::uint16_t* s = &levels_[level - 1].samples[index * 4];
    return Vec4(s[0], s[1], s[2], s[3]) * (1 / 65535.0F);
  }
  const std::size_t at = index * image_.channels;
  if (is_wide_) {
    return decoded(static_cast<const std::uint16_t*>(image_samples_) + at, image_.channels,
                   color_table_, alpha_table_);
  }
  return decoded(static_cast<const std::uint8_t*>(image_samples_) + at, image_.channels,
                 color_table_, alpha_table_);
}

Vec4 TextureMap::sample(const Vec2& uv, float width) const {
  std::size_t level = 0;
  const float pixels = width * static_cast<float>(std::max(image_.width, image_.height));
  if (pixels >= 2 && sampler_.mip != MipFilter::none) {
    // The float's exponent is the whole part of its logarithm.
    const std::size_t exponent = (std::bit_cast<std::uint32_t>(pixels) >> 23U) - 127;
    level = std::min(exponent, levels_.size());
  }
  const Filter filter = pixels > 1 ? sampler_.minification : sampler_.magnification;
  const std::uint32_t columns = level == 0 ? image_.width : levels_[level - 1].width;
  const std::uint32_t rows = level == 0 ? image_.height : levels_[level - 1].height;
  const Between x = between(uv.x, sampler_.wrap_s, columns, filter);
  const Between y = between(uv.y, sampler_.wrap_t, rows, filter);
  const std::size_t top = std::size_t{y.first} * columns, bottom = std::size_t{y.second} * columns;
  const Vec4 upper =
      (1 - x.share) * texel(level, top + x.first) + x.share * texel(level, top + x.second);
  const Vec4 lower =
      (1 - x.share) * texel(level, bottom + x.first) + x.share * texel(level, bottom + x.second);
  return (1 - y.share) * upper + y.share * lower;
}

}  // namespace microtrace
