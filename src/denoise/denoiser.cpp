#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "denoise/filters.hpp"
#include "denoise/library.hpp"

#include <microtrace/denoise.hpp>
#include <microtrace/error.hpp>
#include <microtrace/path.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <glm/common.hpp>

namespace microtrace {
namespace {

/// The memory for denoising a picture. That of the library was measured with versions 2.3.2 and
/// 2.5.1.
void take_denoising_memory(MemoryAccount& account, ImageSize size) {
  constexpr std::uint64_t kFixed = std::uint64_t{17} << 20U, kPixel = 760;
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  const std::uint64_t library = std::min(kFixed + kPixel * pixels, kMostMegabytes * 1'000'000);
  account.take(library + 4 * sizeof(Vec3) * pixels, "denoising");
}

std::size_t pixels_of(const Film& film) {
  return std::size_t{film.size().width} * film.size().height;
}

bool is_channel_of(const Channel& channel, SampledAov aov) {
  return channel.name.starts_with(std::string(name_of(aov)) + ".");
}

/// Returns the three channels of a feature as vectors, row by row. Merged checkpoints may have them
/// in any order.
std::vector<Vec3> vectors_of(const Film& film, SampledAov aov) {
  const std::string_view letters = aov == SampledAov::denoise_normal ? "XYZ" : "RGB";
  std::vector<Vec3> vectors(pixels_of(film));
  for (glm::length_t c = 0; c < 3; ++c) {
    const std::string name = std::string(name_of(aov)) + '.' + letters[static_cast<std::size_t>(c)];
    const auto channel = std::ranges::find(film.channels, name, &Channel::name);
    const auto& values = std::get<std::vector<float>>(channel->values);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i][c] = values[i];
  }
  return vectors;
}

/// Returns true if the value at a pixel equals all values at most this many pixels away, which
/// noise would change. `row_of` returns a row of the values.
bool is_uniform(ImageSize size, const auto& row_of, std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kReach = 2;
  const std::uint32_t x0 = std::max(x, kReach) - kReach, x1 = std::min(x + kReach + 1, size.width);
  const std::uint32_t y0 = std::max(y, kReach) - kReach, y1 = std::min(y + kReach + 1, size.height);
  for (std::uint32_t v = y0; v < y1; ++v) {
    const auto row = row_of(v).subspan(x0, x1 - x0);
    if (std::ranges::any_of(row, [&](const auto& c) { return c != row_of(y)[x]; })) return false;
  }
  return true;
}

bool has_noisy_features(const Film& film) {
  return film.has_lens || film.has_ground;
}

/// Returns the light that is not filtered, from either channel of emission. Emission has no noise,
/// except with a lens and in shadows on a ground. These are darker than white; brighter light, such
/// as that of small lamps, would be blurred.
std::vector<Vec3> exact_light(const Film& film, SampledAov emission) {
  std::vector<Vec3> light = vectors_of(film, emission);
  if (film.has_lens) {
    std::ranges::fill(light, Vec3(0));
  } else if (film.has_ground) {
    for (Vec3& color : light) color = glm::max(color - Vec3(1), Vec3(0));
  }
  return light;
}

/// Removes the noise of features.
void clean_features(const Film& film, Filters& filters, Images& images) {
  // Emission is filtered with the rest of the light, so features need its edges.
  const std::vector<Vec3> emission = vectors_of(film, SampledAov::denoise_emission);
  for (std::size_t i = 0; i < emission.size(); ++i)
    images.albedo[i] = glm::min(images.albedo[i] + emission[i], Vec3(1));
  filters.filter_feature("albedo", images.albedo);
  filters.filter_feature("normal", images.normal);
}

/// Returns the pixels that are not filtered, given the normals: those of the background.
std::vector<bool> background_pixels(const Film& film, std::span<const Vec3> normals) {
  const auto row_of = [&](std::uint32_t y) { return film.row(y); };
  std::vector<bool> is_background(normals.size());
  for (std::uint32_t y = 0, i = 0; y < film.size().height; ++y) {
    for (std::uint32_t x = 0; x < film.size().width; ++x, ++i) {
      // Features have more samples than some pictures, so they may see an edge where these see
      // none.
      is_background[i] = normals[i] == Vec3(0) &&
                         (!has_noisy_features(film) || is_uniform(film.size(), row_of, x, y));
    }
  }
  return is_background;
}

/// Returns the pixels whose alpha has noise, given the normals. With a lens, this is alpha that
/// varies, and otherwise only that of shadows.
std::vector<bool> noisy_alphas(const Film& film, std::span<const Vec3> normals) {
  const auto row_of = [&](std::uint32_t y) { return film.alpha_row(y); };
  std::vector<bool> is_noisy(normals.size());
  for (std::uint32_t y = 0, i = 0; y < film.size().height; ++y) {
    for (std::uint32_t x = 0; x < film.size().width; ++x, ++i) {
      is_noisy[i] =
          (film.has_lens || normals[i] == Vec3(0)) && !is_uniform(film.size(), row_of, x, y);
    }
  }
  return is_noisy;
}

/// Removes the noise of alpha in these pixels. Overwrites images.color.
void filter_alpha(Film& film, Filters& filters, const std::vector<bool>& is_noisy, Images& images) {
  if (std::ranges::find(is_noisy, true) == is_noisy.end()) return;
  const auto [width, height] = film.size();
  for (std::uint32_t y = 0, i = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x, ++i) images.color[i] = Vec3(film.alpha_at(x, y));
  }
  filters.filter_colors(images);
  for (std::uint32_t y = 0, i = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x, ++i) {
      if (is_noisy[i]) film.alpha_at(x, y) = std::clamp(images.color[i].x, 0.0F, 1.0F);
    }
  }
}

/// Denoises a film, which has all features.
void denoise_film(const OidnFunctions& functions, Film& film, const RenderOptions& options) {
  const std::vector<Vec3> emission = exact_light(film, SampledAov::emission);
  Images images{.color = emission,
                .albedo = vectors_of(film, SampledAov::denoise_albedo),
                .normal = vectors_of(film, SampledAov::denoise_normal)};
  const std::vector<bool> is_background = background_pixels(film, images.normal);
  Filters filters(functions, film.size(), options);
  if (has_noisy_features(film)) {
    std::vector<bool> is_noisy;
    if (film.has_alpha()) is_noisy = noisy_alphas(film, images.normal);
    clean_features(film, filters, images);
    if (film.has_alpha()) filter_alpha(film, filters, is_noisy, images);
  }
  const std::uint32_t width = film.size().width, height = film.size().height;
  for (std::uint32_t y = 0, i = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x, ++i)
      images.color[i] = glm::max(film.at(x, y) - emission[i], Vec3(0));
  }
  filters.filter_colors(images);
  const std::vector<Vec3> exact = exact_light(film, SampledAov::denoise_emission);
  for (std::uint32_t y = 0, i = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x, ++i) {
      if (film.has_alpha() && film.alpha_at(x, y) == 0) continue;
      // The background may show other samples of a lamp.
      Vec3& color = film.at(x, y);
      color = is_background[i] ? color + (exact[i] - emission[i]) : exact[i] + images.color[i];
    }
  }
}

}  // namespace

Denoiser::Denoiser() : library_(std::make_unique<const Library>()) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

std::string Denoiser::name() const {
  return "Open Image Denoise " + library_->version;
}

void Denoiser::denoise(Film& film, const RenderOptions& options) const {
  const FloatEnvironment environment;
  if (lacks_denoise_features(film.channels))
    throw Error(ErrorKind::usage, "", "the picture lacks the channels for denoising");
  MemoryAccount memory(options.memory);
  take_denoising_memory(memory, film.size());
  denoise_film(library_->functions, film, options);
  film.denoiser = name();
}

Film Denoiser::render(const PreparedScene& scene, const Camera& camera, ImageSize size,
                      RenderOptions options) const {
  if (dynamic_cast<const PathIntegrator*>(options.integrator) == nullptr)
    throw Error(ErrorKind::usage, "", "only path-traced pictures can be denoised");
  // Taken before rendering, so that no finished picture is lost.
  MemoryAccount memory(options.memory);
  take_denoising_memory(memory, options.crop ? options.crop->size() : size);
  const std::vector<SampledAov> wanted = options.sampled_aovs;
  add_denoise_features(options);
  Film film = microtrace::render(scene, camera, size, options);
  const auto start = std::chrono::steady_clock::now();
  {
    const FloatEnvironment environment;
    denoise_film(library_->functions, film, options);
    film.denoiser = name();
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  if (options.times != nullptr) options.times->denoise = time.count();
  remove_channels(film, channels_only_for_denoising(film.channels, wanted));
  return film;
}

void add_denoise_features(RenderOptions& options) {
  for (const SampledAov aov : kDenoiseFeatures) {
    if (std::ranges::find(options.sampled_aovs, aov) == options.sampled_aovs.end())
      options.sampled_aovs.push_back(aov);
  }
}

bool lacks_denoise_features(std::span<const Channel> channels) {
  return std::ranges::any_of(kDenoiseFeatures, [&](SampledAov aov) {
    return std::ranges::count_if(
               channels, [&](const Channel& channel) { return is_channel_of(channel, aov); }) != 3;
  });
}

std::vector<std::string> channels_only_for_denoising(std::span<const Channel> channels,
                                                     std::span<const SampledAov> wanted) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    const auto has_channel = [&](SampledAov aov) { return is_channel_of(channel, aov); };
    if (std::ranges::any_of(kDenoiseFeatures, has_channel) &&
        std::ranges::none_of(wanted, has_channel))
      names.push_back(channel.name);
  }
  std::ranges::sort(names);
  return names;
}

void remove_channels(Film& film, std::span<const std::string> names) {
  std::erase_if(film.channels, [&](const Channel& channel) {
    return std::ranges::binary_search(names, channel.name);
  });
}

}  // namespace microtrace
