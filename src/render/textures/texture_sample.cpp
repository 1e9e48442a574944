#include "render/textures/texture_map.hpp"

#include <algorithm>
#include <bit>

namespace microtrace {
namespace {

using Between = TextureMap::Between;

/// The largest integer that is not greater than x. |x| must be less than 2^31.
std::int32_t floor_of(float x) {
  const auto whole = static_cast<std::int32_t>(x);
  return whole - (static_cast<float>(whole) > x ? 1 : 0);
}

/// Wraps the coordinate to [0, 1].
float wrapped(float u, Wrap wrap) {
  if (!(u > -0x1p22F && u < 0x1p22F)) return 0;  // float32 has no fraction bits beyond this
  switch (wrap) {
    case Wrap::repeat:
      return u - static_cast<float>(floor_of(u));
    case Wrap::mirrored_repeat: {
      const float turn = u - 2 * static_cast<float>(floor_of(u * 0.5F));
      return turn > 1 ? 2 - turn : turn;
    }
    case Wrap::clamp_to_edge:
      break;
  }
  return std::clamp(u, 0.0F, 1.0F);
}

Between between(float u, Wrap wrap, std::int32_t size, Filter filter) {
  const float position = wrapped(u, wrap) * static_cast<float>(size);
  if (filter == Filter::nearest) {
    const std::int32_t pixel = std::min(static_cast<std::int32_t>(position), size - 1);
    return {.first = pixel, .second = pixel, .share = 0};
  }
  const std::int32_t left = floor_of(position - 0.5F);
  const float share = position - 0.5F - static_cast<float>(left);
  std::int32_t first = left, second = left + 1;
  // Where a mirrored image meets its mirror image, the edge texels repeat, as with clamping.
  if (first < 0) first = wrap == Wrap::repeat ? size - 1 : 0;
  if (second >= size) second = wrap == Wrap::repeat ? 0 : size - 1;
  return {.first = std::min(first, size - 1), .second = second, .share = share};
}

/// Four floats in one register, because GLM would compute them one by one.
typedef float FourFloats __attribute__((vector_size(16)));

/// The weighted mean of four texels. fetch(index) returns the texel with this index; indices count
/// texels row by row.
template <class Fetch>
Vec4 bilinear(const Between& x, const Between& y, std::size_t columns, const Fetch& fetch) {
  const std::size_t top = static_cast<std::size_t>(y.first) * columns;
  const std::size_t bottom = static_cast<std::size_t>(y.second) * columns;
  const auto left = static_cast<std::size_t>(x.first), right = static_cast<std::size_t>(x.second);
  const FourFloats upper = fetch(top + left) * (1 - x.share) + fetch(top + right) * x.share;
  const FourFloats lower = fetch(bottom + left) * (1 - x.share) + fetch(bottom + right) * x.share;
  const FourFloats all = upper * (1 - y.share) + lower * y.share;
  return {all[0], all[1], all[2], all[3]};
}

/// Interpolates texels of the image itself. `color` and `alpha` are the tables of linear values.
template <typename Number>
Vec4 of_image(const Number* samples, std::uint32_t channels, const float* color, const float* alpha,
              const Between& x, const Between& y, std::size_t columns) {
  switch (channels) {
    case 1:
      return bilinear(x, y, columns, [=](std::size_t i) {
        const float gray = color[samples[i]];
        return FourFloats{gray, gray, gray, 1};
      });
    case 2:
      return bilinear(x, y, columns, [=](std::size_t i) {
        const Number* s = samples + 2 * i;
        return FourFloats{color[s[0]], color[s[0]], color[s[0]], alpha[s[1]]};
      });
    case 3:
      return bilinear(x, y, columns, [=](std::size_t i) {
        const Number* s = samples + 3 * i;
        return FourFloats{color[s[0]], color[s[1]], color[s[2]], 1};
      });
    default:
      return bilinear(x, y, columns, [=](std::size_t i) {
        const Number* s = samples + 4 * i;
        return FourFloats{color[s[0]], color[s[1]], color[s[2]], alpha[s[3]]};
      });
  }
}

}  // namespace

TextureMap::TexelAddress TextureMap::texel_address(const Vec2& uv, float width) const {
  std::size_t level = 0;
  const float pixels = width * static_cast<float>(std::max(image_.width, image_.height));
  if (pixels >= 2 && sampler_.mip != MipFilter::none) {
    // The exponent of a float is the integer part of its binary logarithm.
    const std::size_t exponent = (std::bit_cast<std::uint32_t>(pixels) >> 23U) - 127;
    level = std::min(exponent, levels_.size());
  }
  const Filter filter = pixels > 1 ? sampler_.minification : sampler_.magnification;
  const std::uint32_t columns = level == 0 ? image_.width : levels_[level - 1].width;
  const std::uint32_t rows = level == 0 ? image_.height : levels_[level - 1].height;
  return {.level = level,
          .columns = columns,
          .x = between(uv.x, sampler_.wrap_s, static_cast<std::int32_t>(columns), filter),
          .y = between(uv.y, sampler_.wrap_t, static_cast<std::int32_t>(rows), filter)};
}

bool TextureMap::is_laid_out_as(const TextureMap& other) const {
  const Sampler &a = sampler_, &b = other.sampler_;
  return image_.width == other.image_.width && image_.height == other.image_.height &&
         a.wrap_s == b.wrap_s && a.wrap_t == b.wrap_t && a.magnification == b.magnification &&
         a.minification == b.minification && a.mip == b.mip;
}

void TextureMap::fetch(const TexelAddress& address) const {
  const bool is_image = address.level == 0;
  const void* samples = is_image ? image_samples_ : levels_[address.level - 1].samples.data();
  const std::size_t size = is_image ? image_.channels * (is_wide_ ? 2U : 1U) : 8;
  for (const std::int32_t row : {address.y.first, address.y.second}) {
    const std::size_t pixel =
        static_cast<std::size_t>(row) * address.columns + static_cast<std::size_t>(address.x.first);
    __builtin_prefetch(static_cast<const char*>(samples) + pixel * size);
  }
}

Vec4 TextureMap::sample(const TexelAddress& address) const {
  const auto& [level, columns, x, y] = address;
  if (level > 0) {
    const std::uint16_t* samples = levels_[level - 1].samples.data();
    return bilinear(x, y, columns,
                    [=](std::size_t i) {
                      const std::uint16_t* s = samples + 4 * i;
                      return FourFloats{float(s[0]), float(s[1]), float(s[2]), float(s[3])};
                    }) *
           (1 / 65535.0F);
  }
  const float *color = color_table_.data(), *alpha = alpha_table_.data();
  if (is_wide_) {
    return of_image(static_cast<const std::uint16_t*>(image_samples_), image_.channels, color,
                    alpha, x, y, columns);
  }
  return of_image(static_cast<const std::uint8_t*>(image_samples_), image_.channels, color, alpha,
                  x, y, columns);
}

}  // namespace microtrace
