#include "render/samples/sampled_aov_painter.hpp"

#include "base/system/float_environment.hpp"
#include "render/aovs/feature_tracer.hpp"
#include "render/film/tiles.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/common.hpp>

namespace microtrace {
namespace {

/// The number of samples per pixel for which features are computed, even if colors have fewer
/// samples. It suffices to antialias edges.
constexpr std::uint32_t kFeatureSamples = 32;

/// The least number of samples of SampledAov::denoise_emission where lamps may be visible.
constexpr std::uint32_t kEmissionSamples = 256;

struct Row {
  std::string_view name;
  std::string_view channels;  ///< one letter per channel
};

const Row& row_of(SampledAov aov) {
  // Rows are in the order of SampledAov.
  static constexpr std::array kRows = {Row{"variance", "Y"},          Row{"samples", "N"},
                                       Row{"denoise_albedo", "RGB"},  Row{"denoise_normal", "XYZ"},
                                       Row{"emission", "RGB"},        Row{"noisy", "RGB"},
                                       Row{"denoise_emission", "RGB"}};
  static_assert(kRows.size() == kSampledAovs.size());
  return kRows[static_cast<std::size_t>(aov)];
}

/// The value of a quantity that depends only on a pixel's sums. `background` is black if the film
/// has alpha.
float value_of(SampledAov aov, std::size_t channel, const PixelSum& sum, const Vec3& background) {
  if (aov == SampledAov::variance) return static_cast<float>(sum.variance(background));
  if (aov == SampledAov::samples) return static_cast<float>(sum.count);
  const Vec3 color = sum.mean_color() + (1 - sum.mean_alpha()) * background;
  return color[static_cast<glm::length_t>(channel)];
}

/// Options of paths that end at the first surface. Where the background is seen, the colors are the
/// same, including shadows on a ground.
PathOptions ending_at_once(const Integrator* integrator) {
  PathOptions options;
  if (const auto* paths = dynamic_cast<const PathIntegrator*>(integrator); paths != nullptr)
    options = paths->options();
  options.max_depth = 1;
  options.guiding = false;
  return options;
}

constexpr std::array kAovsOfSums = {SampledAov::variance, SampledAov::samples, SampledAov::noisy};

std::optional<SampledAov> aov_of_sums(std::string_view channel) {
  const auto aov = sampled_aov_named(channel.substr(0, channel.find('.')));
  const bool is_of_sums = aov && std::ranges::find(kAovsOfSums, *aov) != kAovsOfSums.end();
  return is_of_sums ? aov : std::nullopt;
}

}  // namespace

bool is_computed_channel(std::string_view name) {
  return aov_of_sums(name).has_value();
}

void compute_channels(const SampleSums& sums, std::span<Channel> channels) {
  const FloatEnvironment environment;
  for (Channel& channel : channels) {
    const std::optional<SampledAov> aov = aov_of_sums(channel.name);
    if (!aov) continue;
    const std::size_t index = row_of(*aov).channels.find(channel.name.back());
    std::vector<float> values;
    values.reserve(sums.pixels.size());
    for (const PixelSum& pixel : sums.pixels)
      values.push_back(value_of(*aov, index, pixel, sums.background));
    channel.values = std::move(values);
  }
}

std::string_view name_of(SampledAov aov) {
  return row_of(aov).name;
}

std::optional<SampledAov> sampled_aov_named(std::string_view name) {
  for (const SampledAov aov : kSampledAovs) {
    if (name_of(aov) == name) return aov;
  }
  return std::nullopt;
}

SampledAovPainter::SampledAovPainter(const World& world, const RenderOptions& options,
                                     const Vec3& background, const PixelRect& window, Film& film)
    : world_(world),
      options_(options),
      ray_(world.camera, world.scene),
      filter_(options.filter),
      background_(background),
      light_(ending_at_once(options.integrator)),
      emission_(world, light_, options, background),
      window_(window),
      film_(film) {
  film.has_lens = ray_.has_lens();
  film.has_ground = light_.options().ground.has_value();
  first_.fill(kNone);
  const std::size_t pixels = std::size_t{film.size().width} * film.size().height;
  for (const SampledAov aov : options.sampled_aovs) {
    first_[static_cast<std::size_t>(aov)] = film.channels.size();
    for (const char letter : row_of(aov).channels) {
      film.channels.push_back({.name = std::string(name_of(aov)).append(".").append(1, letter),
                               .values = std::vector<float>(pixels)});
    }
  }
  if (has(SampledAov::denoise_emission)) lamps_.emplace(world.scene, world.camera, window);
}

float& SampledAovPainter::value(SampledAov aov, std::size_t channel, std::size_t pixel) const {
  const std::size_t first = first_[static_cast<std::size_t>(aov)];
  return std::get<std::vector<float>>(film_.channels[first + channel].values)[pixel];
}

void SampledAovPainter::set(std::size_t pixel, const PixelSum& sum) const {
  for (const SampledAov aov : kAovsOfSums) {
    if (!has(aov)) continue;
    for (std::size_t c = 0; c < row_of(aov).channels.size(); ++c)
      value(aov, c, pixel) = value_of(aov, c, sum, background_);
  }
}

std::size_t SampledAovPainter::index_of(const PixelRect& tile, std::size_t i) const {
  const std::size_t width = tile.size().width;
  const std::size_t x = tile.x0 - window_.x0 + i % width, y = tile.y0 - window_.y0 + i / width;
  return y * film_.size().width + x;
}

void SampledAovPainter::paint(const PixelRect& tile, std::span<const SampleRange> samples,
                              std::uint32_t count) const {
  if (has(SampledAov::denoise_albedo) || has(SampledAov::denoise_normal)) paint_features(tile);
  if (has(SampledAov::emission) || has(SampledAov::denoise_emission))
    paint_emission(tile, samples, count);
}

void SampledAovPainter::paint_features(const PixelRect& tile) const {
  std::array<Ray, kTilePixels> rays;
  std::array<DenoiseFeatures, kTilePixels> features;
  std::array<DVec3, kTilePixels> albedos{}, normals{};
  const ImageSize size = tile.size();
  const std::size_t pixels = std::size_t{size.width} * size.height;
  FeatureTracer tracer(world_);
  for (std::uint32_t k = 0; k < kFeatureSamples; ++k) {
    for (std::size_t i = 0; i < pixels; ++i) {
      const auto x = tile.x0 + static_cast<std::uint32_t>(i % size.width);
      const auto y = tile.y0 + static_cast<std::uint32_t>(i / size.width);
      const std::uint32_t key = sampling::pixel_key(world_.seed, x, y);
      const sampling::Sobol random(key, k);
      const Vec2 uv = random.pair(sampling::kPixelPair);
      const PixelOffset offset = filter_(uv.x, uv.y);
      rays[i] = ray_.sample(x + offset.x, y + offset.y, random.pair(sampling::kLensPair));
    }
    tracer.trace(std::span(rays).first(pixels), std::span(features).first(pixels));
    for (std::size_t i = 0; i < pixels; ++i) {
      albedos[i] += DVec3(features[i].albedo);
      normals[i] += DVec3(features[i].normal);
    }
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto store = [&](SampledAov aov, const DVec3& sum) {
      if (!has(aov)) return;
      for (std::size_t c = 0; c < 3; ++c) {
        value(aov, c, index_of(tile, i)) =
            static_cast<float>(sum[static_cast<glm::length_t>(c)] / kFeatureSamples);
      }
    };
    store(SampledAov::denoise_albedo, albedos[i]);
    store(SampledAov::denoise_normal, normals[i]);
  }
}

void SampledAovPainter::paint_emission(const PixelRect& tile, std::span<const SampleRange> samples,
                                       std::uint32_t count) const {
  std::array<PixelSum, kTilePixels> pixels{};
  const ImageSize size = tile.size();
  const std::span sums = std::span(pixels).first(std::size_t{size.width} * size.height);
  std::uint32_t last = 0;
  for (SampleRange range : samples) {
    range.last = std::min(range.last, range.first + count);
    count -= range.size();
    if (range.size() > 0) emission_.add(tile, range, pixels);
    last = std::max(last, range.last);
  }
  if (has(SampledAov::emission)) set_emission(SampledAov::emission, tile, sums);
  if (!has(SampledAov::denoise_emission)) return;
  if (last < kEmissionSamples) add_at_lamps(tile, {.first = last, .last = kEmissionSamples}, sums);
  set_emission(SampledAov::denoise_emission, tile, sums);
}

void SampledAovPainter::add_at_lamps(const PixelRect& tile, const SampleRange& range,
                                     std::span<PixelSum> sums) const {
  // The choice must not depend on samples: leaving out pixels whose first samples miss a lamp would
  // make lamps too dark.
  const std::uint32_t width = tile.size().width;
  std::uint32_t count = 0;
  std::array<PixelRect, kTilePixels> pixels;
  for (std::uint32_t i = 0; i < sums.size(); ++i) {
    const std::uint32_t x = tile.x0 + i % width, y = tile.y0 + i / width;
    if (lamps_->contains(x, y)) pixels[count++] = {.x0 = x, .y0 = y, .x1 = x + 1, .y1 = y + 1};
  }
  if (count == sums.size()) return emission_.add(tile, range, sums);  // takes less time
  for (const PixelRect& pixel : std::span(pixels).first(count)) {
    const std::uint32_t i = (pixel.y0 - tile.y0) * width + (pixel.x0 - tile.x0);
    emission_.add(pixel, range, sums.subspan(i, 1));
  }
}

void SampledAovPainter::set_emission(SampledAov aov, const PixelRect& tile,
                                     std::span<const PixelSum> sums) const {
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      value(aov, c, index_of(tile, i)) = value_of(SampledAov::noisy, c, sums[i], background_);
  }
}

}  // namespace microtrace
