#include "render/textures/texture_map.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace microtrace {
namespace {

/// Wraps the coordinate to [0, 1], or to [0, 2] for mirrored images, so that pixel indices can't
/// overflow.
double wrapped(double u, Wrap wrap) {
  if (!std::isfinite(u)) return 0;
  switch (wrap) {
    case Wrap::repeat:
      return u - std::floor(u);
    case Wrap::mirrored_repeat:
      return u - 2 * std::floor(u / 2);
    case Wrap::clamp_to_edge:
      break;
  }
  return std::clamp(u, 0.0, 1.0);
}

/// The index of the pixel that appears at the index i, which may be slightly outside the image.
std::uint32_t wrapped_pixel(std::int64_t i, std::int64_t size, Wrap wrap) {
  if (wrap == Wrap::repeat) {
    i %= size;
    if (i < 0) i += size;
  } else if (wrap == Wrap::mirrored_repeat) {
    i %= 2 * size;
    if (i < 0) i += 2 * size;
    if (i >= size) i = 2 * size - 1 - i;
  }
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(i, 0, size - 1));
}

TexelGrid::Axis axis_of(std::uint32_t size, Wrap wrap) {
  return {.size = static_cast<std::int32_t>(size),
          .is_repeated = wrap == Wrap::repeat,
          .is_mirrored = wrap == Wrap::mirrored_repeat};
}

}  // namespace

TextureMap::TextureMap(const Image& image, const Sampler& sampler, ColorEncoding encoding)
    : TextureMap(std::make_shared<TexturePyramid>(
                     std::shared_ptr<const Image>(std::shared_ptr<void>(), &image), encoding),
                 sampler) {}

TextureMap::TextureMap(const std::shared_ptr<TexturePyramid>& pyramid, const Sampler& sampler)
    : pyramid_(pyramid), image_(pyramid->image()), sampler_(sampler) {
  is_wide_ = std::holds_alternative<std::vector<std::uint16_t>>(image_.samples);
  color_table_ = pyramid->color_table();
  alpha_table_ = pyramid->alpha_table();
  if (sampler.mip != MipFilter::none) levels_ = pyramid->levels();
  level_samples_.push_back(std::visit(
      [](const auto& samples) -> const void* { return samples.data(); }, image_.samples));
  for (const TexturePyramid::Level& level : levels_) level_samples_.push_back(level.samples.data());
  grid_ = {.x = axis_of(image_.width, sampler.wrap_s),
           .y = axis_of(image_.height, sampler.wrap_t),
           .last_level = static_cast<std::int32_t>(levels_.size()),
           .is_nearest_magnified = sampler.magnification == Filter::nearest,
           .is_nearest_minified = sampler.minification == Filter::nearest};
}

DVec2 TextureMap::level_size(std::size_t level) const {
  if (level == 0) return {image_.width, image_.height};
  return {levels_[level - 1].width, levels_[level - 1].height};
}

DVec4 TextureMap::filtered(std::size_t level, Filter filter, const DVec2& uv) const {
  const DVec2 size = level_size(level);
  const auto width = static_cast<std::int64_t>(size.x), height = static_cast<std::int64_t>(size.y);
  const DVec2 position(wrapped(uv.x, sampler_.wrap_s) * size.x,
                       wrapped(uv.y, sampler_.wrap_t) * size.y);
  const auto at = [&](std::int64_t x, std::int64_t y) {
    return pyramid_->pixel(level, wrapped_pixel(x, width, sampler_.wrap_s),
                           wrapped_pixel(y, height, sampler_.wrap_t));
  };
  if (filter == Filter::nearest) {
    return at(static_cast<std::int64_t>(position.x), static_cast<std::int64_t>(position.y));
  }
  const double left = std::floor(position.x - 0.5), top = std::floor(position.y - 0.5);
  const double right = position.x - 0.5 - left, down = position.y - 0.5 - top;
  const auto x = static_cast<std::int64_t>(left), y = static_cast<std::int64_t>(top);
  return (1 - down) * ((1 - right) * at(x, y) + right * at(x + 1, y)) +
         down * ((1 - right) * at(x, y + 1) + right * at(x + 1, y + 1));
}

DVec4 TextureMap::minified(const DVec2& uv, double width) const {
  if (sampler_.mip == MipFilter::none) return filtered(0, sampler_.minification, uv);
  // Level k is for footprints with a width of 2^k texels. Between two levels, the weight is linear
  // in the width.
  int exponent = 0;
  const double mantissa = std::frexp(width, &exponent);  // in [1/2, 1)
  const std::size_t last = level_count() - 1;
  const auto level = static_cast<std::size_t>(exponent - 1);
  if (level >= last) return filtered(last, sampler_.minification, uv);
  const double coarser = 2 * mantissa - 1;
  if (sampler_.mip == MipFilter::nearest) {
    return filtered(level + (coarser >= 0.5 ? 1 : 0), sampler_.minification, uv);
  }
  return (1 - coarser) * filtered(level, sampler_.minification, uv) +
         coarser * filtered(level + 1, sampler_.minification, uv);
}

DVec4 TextureMap::look_up(const DVec2& uv, const TextureFootprint& footprint) const {
  const DVec2 size = level_size(0);
  const auto length = [&](const DVec2& step) {
    const DVec2 pixels = step * size;
    return std::sqrt(pixels.x * pixels.x + pixels.y * pixels.y);
  };
  const double across = length(footprint.dx), down = length(footprint.dy);
  const double longer = std::max(across, down), shorter = std::min(across, down);
  if (!(longer > 1)) return filtered(0, sampler_.magnification, uv);
  if (!std::isfinite(longer)) return filtered(level_count() - 1, sampler_.minification, uv);
  const bool one = sampler_.mip == MipFilter::none || sampler_.minification == Filter::nearest;
  // The margin ensures that a footprint that is square except for rounding gets only one probe.
  const double wished = std::ceil(longer / std::max(shorter, 1.0) - 0x1p-10);
  const int probes = one ? 1 : static_cast<int>(std::min<double>(wished, kMaxProbes));
  const double width = one ? longer : longer / probes;
  const DVec2 step = (across > down ? footprint.dx : footprint.dy) / static_cast<double>(probes);
  DVec4 sum(0);
  for (int i = 0; i < probes; ++i) {
    const DVec2 place = uv + (i - (probes - 1) / 2.0) * step;
    sum += width > 1 ? minified(place, width) : filtered(0, sampler_.magnification, place);
  }
  return sum / static_cast<double>(probes);
}

Vec4 TextureMap::sample(const TexelAddress<1>& address) const {
  const FourFloats texel = read_texel(texels(), address);
  return {texel[0], texel[1], texel[2], texel[3]};
}

}  // namespace microtrace
