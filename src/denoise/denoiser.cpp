#include "base/memory_account.hpp"
#include "base/start_threads.hpp"
#include "denoise/library.hpp"
#include "float_environment.hpp"

#include <microtrace/denoise.hpp>
#include <microtrace/error.hpp>
#include <microtrace/path.hpp>
#include <microtrace/threads.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <glm/common.hpp>

namespace microtrace {
namespace {

/// The library divides larger pictures into parts, so that it needs no more memory than this. The
/// limit is constant, because it affects the result.
constexpr std::uint64_t kMostMegabytes = 1000;

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

/// Returns the three channels of a feature as vectors, row by row.
std::vector<Vec3> vectors_of(const Film& film, SampledAov aov) {
  const auto first =
      std::ranges::find_if(film.channels, [&](const Channel& c) { return is_channel_of(c, aov); });
  std::vector<Vec3> vectors(pixels_of(film));
  for (glm::length_t c = 0; c < 3; ++c) {
    const auto& values = std::get<std::vector<float>>(first[c].values);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i][c] = values[i];
  }
  return vectors;
}

/// Passes calls of the library on to a progress function, whose exceptions must not propagate
/// through the library's frames.
struct ProgressMonitor {
  const std::function<bool(double)>& progress;
  std::atomic<bool> is_canceled = false;
  std::exception_ptr thrown{};

  static bool goes_on(void* context, double /*share*/) {
    auto& self = *static_cast<ProgressMonitor*>(context);
    try {
      if (self.is_canceled || self.progress(1)) return !self.is_canceled;
    } catch (...) {
      self.thrown = std::current_exception();
    }
    self.is_canceled = true;
    return false;
  }
};

/// The images of a filter, in rows of the film's width.
struct FilterImages {
  std::vector<Vec3> color, albedo, normal;
};

/// Replaces the colors by denoised ones.
void run_filter(const OidnFunctions& f, ImageSize size, FilterImages& images,
                const RenderOptions& options) {
  // The library ends the process if the system refuses a thread.
  const unsigned wanted = options.threads != 0 ? options.threads : default_threads();
  const oidn::Device device = oidn::open_device(f, can_start_threads(wanted) ? wanted : 1);
  const oidn::Filter filter(f.new_filter(device.get(), "RT"), {&f});
  const auto set = [&](const char* name, std::vector<Vec3>& pixels) {
    f.set_shared_filter_image(filter.get(), name, pixels.data(), oidn::kFloat3, size.width,
                              size.height, 0, 0, 0);
  };
  set("color", images.color);
  set("albedo", images.albedo);
  set("normal", images.normal);
  set("output", images.color);
  f.set_filter_bool(filter.get(), "hdr", true);
  f.set_filter_bool(filter.get(), "cleanAux", true);
  f.set_filter_int(filter.get(), "maxMemoryMB", static_cast<int>(kMostMegabytes));
  ProgressMonitor monitor{.progress = options.progress};
  if (options.progress) {
    f.set_filter_progress_monitor_function(filter.get(), ProgressMonitor::goes_on, &monitor);
  }
  f.commit_filter(filter.get());
  f.execute_filter(filter.get());
  if (monitor.thrown) std::rethrow_exception(monitor.thrown);
  const char* message = nullptr;
  const int error = f.get_device_error(device.get(), &message);
  if (error == 0) return;
  const ErrorKind kind = error == oidn::kCanceled      ? ErrorKind::canceled
                         : error == oidn::kOutOfMemory ? ErrorKind::limit
                                                       : ErrorKind::internal;
  throw Error(kind, "", std::string("denoising failed: ") + message);
}

/// Denoises a film, which has all features.
void denoise_film(const OidnFunctions& functions, Film& film, const RenderOptions& options) {
  const std::vector<Vec3> emission = vectors_of(film, SampledAov::emission);
  FilterImages images{.color = emission,
                      .albedo = vectors_of(film, SampledAov::denoise_albedo),
                      .normal = vectors_of(film, SampledAov::denoise_normal)};
  const std::uint32_t width = film.size().width, height = film.size().height;
  for (std::uint32_t y = 0, i = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x, ++i)
      images.color[i] = glm::max(film.at(x, y) - emission[i], Vec3(0));
  }
  run_filter(functions, film.size(), images, options);
  for (std::uint32_t y = 0, i = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x, ++i) {
      // Features have more samples than some pictures, so they may see an edge where these see
      // none.
      const bool is_background =
          images.normal[i] == Vec3(0) || (film.has_alpha() && film.alpha_at(x, y) == 0);
      if (!is_background) film.at(x, y) = emission[i] + images.color[i];
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
  std::erase_if(film.channels, [&](const Channel& channel) {
    return is_denoise_feature(channel) && std::ranges::none_of(wanted, [&](SampledAov aov) {
             return is_channel_of(channel, aov);
           });
  });
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

bool is_denoise_feature(const Channel& channel) {
  return std::ranges::any_of(kDenoiseFeatures,
                             [&](SampledAov aov) { return is_channel_of(channel, aov); });
}

}  // namespace microtrace
