#include "render/textures/alpha_bounds.hpp"

#include <array>
#include <cmath>
#include <variant>

namespace microtrace {
namespace {

/// Up to two intervals of texels.
template <class Texels>
struct Parts {
  std::array<Texels, 2> part;
  std::size_t count;
};

/// Maps an interval of texels of the plane that repetitions of an image cover to the image.
template <class Texels>
Parts<Texels> wrapped(Texels t, Wrap wrap, std::int64_t size) {
  const auto one = [](std::int64_t first, std::int64_t last) {
    return Parts<Texels>{.part = {Texels{first, last}, Texels{}}, .count = 1};
  };
  if (wrap == Wrap::clamp_to_edge)
    return one(std::clamp<std::int64_t>(t.first, 0, size - 1),
               std::clamp<std::int64_t>(t.last, 0, size - 1));
  if (t.last - t.first + 1 >= size) return one(0, size - 1);
  const std::int64_t period = wrap == Wrap::repeat ? size : 2 * size;
  const std::int64_t first = (t.first % period + period) % period;
  const std::int64_t last = first + (t.last - t.first);
  if (wrap == Wrap::repeat) {
    if (last < size) return one(first, last);
    return {.part = {Texels{first, size - 1}, Texels{0, last - size}}, .count = 2};
  }
  // In the second half of the period, the image is mirrored.
  const auto mirrored = [&](std::int64_t x) { return 2 * size - 1 - x; };
  if (first < size)
    return one(last < size ? first : std::min(first, mirrored(last)),
               last < size ? last : size - 1);
  if (last < period) return one(mirrored(last), mirrored(first));
  return one(0, std::max(mirrored(first), last - period));
}

/// The texels that lookups with one coordinate in an interval read. The lookups round the wrapped
/// coordinate, which is at most 2, its product with the size, and the distance from half a texel,
/// each with a relative error of at most 2^-24.
template <class Texels>
Texels touched(const ValueInterval& u, std::int64_t size, Filter filter) {
  const double margin = 0x1p-21 * static_cast<double>(size);
  const double half = filter == Filter::linear ? 0.5 : 0;
  const auto texel = [half](double x) { return static_cast<std::int64_t>(std::floor(x - half)); };
  const double scale = static_cast<double>(size);
  return {texel(u.lo * scale - margin),
          texel(u.hi * scale + margin) + (filter == Filter::linear ? 1 : 0)};
}

}  // namespace

AlphaBounds::AlphaBounds(const Image& image) : image_(image), memory_(memory_account().budget()) {
  if (image.channels % 2 != 0) return;
  std::uint64_t blocks = 0;
  for (std::uint64_t width = image_.width, height = image_.height; std::max(width, height) > 1;) {
    width = (width + 1) / 2;
    height = (height + 1) / 2;
    blocks += width * height;
  }
  memory_.take(blocks * sizeof(Values), "the alpha of a texture");
  for (std::uint64_t size = std::max(image_.width, image_.height); size > 1; size = (size + 1) / 2)
    add_level();
}

void AlphaBounds::add_level() {
  const std::size_t finer = levels_.size();
  const auto size = [&](std::uint32_t texels) { return ((std::int64_t{texels} - 1) >> finer) + 1; };
  const std::int64_t width = size(image_.width), height = size(image_.height);
  Level level{.width = (width + 1) / 2, .values = {}};
  level.values.resize(static_cast<std::size_t>(level.width * ((height + 1) / 2)));
  const auto add = [&](const auto& values_at) {
    for (std::int64_t y = 0; y < height; ++y) {
      Values* const row = &level.values[static_cast<std::size_t>(y / 2 * level.width)];
      for (std::int64_t x = 0; x < width; ++x) row[x / 2].add(values_at(x, y));
    }
  };
  if (finer > 0)
    add([&](std::int64_t x, std::int64_t y) { return values(finer, x, y); });
  else
    std::visit(
        [&](const auto& samples) {
          const std::size_t channels = image_.channels;
          const auto* const alphas = samples.data() + channels - 1;
          add([=](std::int64_t x, std::int64_t y) {
            const std::uint16_t alpha = alphas[static_cast<std::size_t>(y * width + x) * channels];
            return Values{.least = alpha, .greatest = alpha};
          });
        },
        image_.samples);
  levels_.push_back(std::move(level));
}

AlphaBounds::Values AlphaBounds::texel(std::int64_t x, std::int64_t y) const {
  const std::size_t pixel =
      static_cast<std::size_t>(y) * image_.width + static_cast<std::size_t>(x);
  return std::visit(
      [&](const auto& samples) {
        const std::uint16_t value = samples[pixel * image_.channels + image_.channels - 1];
        return Values{.least = value, .greatest = value};
      },
      image_.samples);
}

AlphaBounds::Values AlphaBounds::over(const Texels& x, const Texels& y) const {
  constexpr std::int64_t kMost = 4;  // blocks along an axis, and one more
  std::size_t level = 0;
  while (level < levels_.size() && std::max(x.last - x.first, y.last - y.first) >> level > kMost)
    ++level;
  Values sum;
  for (std::int64_t j = y.first >> level; j <= y.last >> level; ++j)
    for (std::int64_t i = x.first >> level; i <= x.last >> level; ++i) sum.add(values(level, i, j));
  return sum;
}

ValueInterval AlphaBounds::over(const TextureMap& map, const ValueInterval& u,
                                const ValueInterval& v) const {
  // The lookup's weights have a sum of 1 but for rounding.
  constexpr double kOfWeights = 0x1p-20;
  const Sampler& sampler = map.sampler();
  if (image_.channels % 2 != 0) return {1 - kOfWeights, 1 + kOfWeights};
  const auto columns = wrapped(touched<Texels>(u, image_.width, sampler.magnification),
                               sampler.wrap_s, image_.width);
  const auto rows = wrapped(touched<Texels>(v, image_.height, sampler.magnification),
                            sampler.wrap_t, image_.height);
  Values sum;
  for (std::size_t i = 0; i < columns.count; ++i)
    for (std::size_t j = 0; j < rows.count; ++j) sum.add(over(columns.part[i], rows.part[j]));
  return {double{map.alpha(sum.least)} * (1 - kOfWeights),
          double{map.alpha(sum.greatest)} * (1 + kOfWeights)};
}

}  // namespace microtrace
