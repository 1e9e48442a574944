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
#include <initializer_list>
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

/// The images of a picture, in rows of its width.
struct Images {
  std::vector<Vec3> color, albedo, normal;
};

struct NamedImage {
  const char* name;
  std::vector<Vec3>& pixels;
};

/// Runs the library's filters on images of one size.
class Filters {
 public:
  /// The arguments must outlive this object.
  Filters(const OidnFunctions& functions, ImageSize size, const RenderOptions& options)
      : f_(functions), size_(size), monitor_{.progress = options.progress} {
    // The library ends the process if the system refuses a thread.
    const unsigned wanted = options.threads != 0 ? options.threads : default_threads();
    device_ = oidn::open_device(f_, can_start_threads(wanted) ? wanted : 1);
  }

  /// Replaces the colors by denoised ones. The features must be free of noise.
  void filter_colors(Images& images) {
    run({{"color", images.color}, {"albedo", images.albedo}, {"normal", images.normal}});
  }

  /// Replaces a feature, the library's "albedo" or "normal", by a denoised one.
  void filter_feature(const char* name, std::vector<Vec3>& pixels) { run({{name, pixels}}); }

 private:
  /// Replaces the first image. The others are its guides.
  void run(std::initializer_list<NamedImage> images) {
    const oidn::Filter filter(f_.new_filter(device_.get(), "RT"), {&f_});
    const auto set = [&](const char* name, std::vector<Vec3>& pixels) {
      f_.set_shared_filter_image(filter.get(), name, pixels.data(), oidn::kFloat3, size_.width,
                                 size_.height, 0, 0, 0);
    };
    for (const auto& [name, pixels] : images) set(name, pixels);
    set("output", images.begin()->pixels);
    if (images.size() > 1) {
      f_.set_filter_bool(filter.get(), "hdr", true);
      f_.set_filter_bool(filter.get(), "cleanAux", true);
    }
    f_.set_filter_int(filter.get(), "maxMemoryMB", static_cast<int>(kMostMegabytes));
    if (monitor_.progress) {
      f_.set_filter_progress_monitor_function(filter.get(), ProgressMonitor::goes_on, &monitor_);
    }
    f_.commit_filter(filter.get());
    f_.execute_filter(filter.get());
    check();
  }

  /// Throws the error of the last filter, if it failed.
  void check() {
    if (monitor_.thrown) std::rethrow_exception(monitor_.thrown);
    const char* message = nullptr;
    const int error = f_.get_device_error(device_.get(), &message);
    if (error == 0) return;
    const ErrorKind kind = error == oidn::kCanceled      ? ErrorKind::canceled
                           : error == oidn::kOutOfMemory ? ErrorKind::limit
                                                         : ErrorKind::internal;
    throw Error(kind, "", std::string("denoising failed: ") + message);
  }

  const OidnFunctions& f_;
  ImageSize size_;
  ProgressMonitor monitor_;
  oidn::Device device_;
};

/// Returns true if the color equals all colors at most this many pixels away, which noise would
/// change.
bool is_uniform(const Film& film, std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kReach = 2;
  const auto [width, height] = film.size();
  const std::uint32_t x0 = std::max(x, kReach) - kReach, x1 = std::min(x + kReach + 1, width);
  for (std::uint32_t v = std::max(y, kReach) - kReach; v < std::min(y + kReach + 1, height); ++v) {
    const std::span<const Vec3> row = film.row(v).subspan(x0, x1 - x0);
    if (std::ranges::any_of(row, [&](const Vec3& c) { return c != film.row(y)[x]; })) return false;
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
std::vector<bool> background_pixels(Film& film, std::span<const Vec3> normals) {
  std::vector<bool> is_background(normals.size());
  for (std::uint32_t y = 0, i = 0; y < film.size().height; ++y) {
    for (std::uint32_t x = 0; x < film.size().width; ++x, ++i) {
      // Features have more samples than some pictures, so they may see an edge where these see
      // none.
      is_background[i] =
          normals[i] == Vec3(0) && (!has_noisy_features(film) || is_uniform(film, x, y));
    }
  }
  return is_background;
}

/// Denoises a film, which has all features.
void denoise_film(const OidnFunctions& functions, Film& film, const RenderOptions& options) {
  const std::vector<Vec3> emission = exact_light(film, SampledAov::emission);
  Images images{.color = emission,
                .albedo = vectors_of(film, SampledAov::denoise_albedo),
                .normal = vectors_of(film, SampledAov::denoise_normal)};
  const std::vector<bool> is_background = background_pixels(film, images.normal);
  Filters filters(functions, film.size(), options);
  if (has_noisy_features(film)) clean_features(film, filters, images);
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
